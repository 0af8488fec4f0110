// What the chips of a real robot make of a quantity: constants of the robots' library (2024-11), and plain functions.
// The inertial measurement unit is an ICM-20689; light sensors and battery share a converter of 10 bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "world/specs.hpp"

namespace pogosim {

inline constexpr float kGravity = 9.80665F;  // m/s2

// Ranges of the ICM-20689 as the robots set it: +-16 g, +-2000 degrees per second, -40 to 85 degrees Celsius.
inline constexpr float kMaxAcceleration = 16.0F * kGravity;
inline constexpr float kMaxAngularVelocity = 2000.0F * std::numbers::pi_v<float> / 180.0F;
inline constexpr float kMinTemperature = -40.0F;
inline constexpr float kMaxTemperature = 85.0F;

// One count of its 16 bits.
inline constexpr float kAccelerationStep = 0.0047886F;      // m/s2
inline constexpr float kAngularVelocityStep = 0.00106528F;  // rad/s
inline constexpr float kTemperatureCountsPerC = 333.87F;
inline constexpr float kTemperatureOffset = 21.0F;  // degrees Celsius, and counts

inline constexpr double kBatteryStepMv = 6.445;  // of a count of the converter
inline constexpr int kConverterBits = 10;

/// The nearest whole number of steps that 16 bits can express, times the step.
inline float in_counts(float value, float step) {
    return step * std::clamp(std::round(value / step), static_cast<float>(INT16_MIN), static_cast<float>(INT16_MAX));
}

/// A level of light from 0 to 32767, or beyond these with noise and bias, as a converter of so many bits gives it: 0 to
/// 2^bits - 1, with the same level of light at full scale. kLightBits: as it is.
inline int converted_light(int level, int bits) {
    if (bits >= kLightBits) {
        return level;
    }
    constexpr int most = (1 << kLightBits) - 1;
    return std::clamp(level, 0, most) >> (kLightBits - bits);
}

/// A temperature within the range of the chip; as it is, or as a whole number of counts gives it.
inline float thermometer_c(float temperature_c, SensorModel model) {
    float const within = std::clamp(temperature_c, kMinTemperature, kMaxTemperature);
    if (model == SensorModel::ideal) {
        return within;
    }
    float const counts = std::round((within - kTemperatureOffset) * kTemperatureCountsPerC + kTemperatureOffset);
    return kTemperatureOffset + (counts - kTemperatureOffset) / kTemperatureCountsPerC;
}

/// A voltage as pogobot_battery_voltage_read() gives it, mV.
inline std::int16_t voltmeter_mv(double voltage_mv, SensorModel model) {
    if (model == SensorModel::ideal) {
        return static_cast<std::int16_t>(std::lround(voltage_mv));
    }
    constexpr double most = (1 << kConverterBits) - 1;
    return static_cast<std::int16_t>(kBatteryStepMv * std::clamp(std::floor(voltage_mv / kBatteryStepMv), 0.0, most));
}

}  // namespace pogosim
