// pogolib/sensors.h
#include <algorithm>
#include <cstdint>
#include <numbers>

#include "robot/context.hpp"
#include "robot/require_robot.hpp"
#include "robot/robot_floating_point.hpp"
#include "robot/sensing.hpp"
#include "robot/slip.hpp"
#include "robot/waiting.hpp"
#include "world/observed_motion.hpp"

using pogosim::context;
using pogosim::require_argument;
using pogosim::require_robot;
using pogosim::Vec2;

namespace {

// Ranges of the ICM-20689 on the robot: +-16 g, +-2000 degrees per second, -40 to 85 degrees Celsius.
constexpr float kMaxAcceleration = 16.0F * 9.80665F;
constexpr float kMaxAngularVelocity = 2000.0F * std::numbers::pi_v<float> / 180.0F;
constexpr float kMinTemperature = -40.0F;
constexpr float kMaxTemperature = 85.0F;

}  // namespace

int16_t pogobot_photosensors_read(uint8_t sensor_number) {
    require_robot(__func__);
    pogosim::note_call();
    pogosim::take_back_floating_point();
    if (sensor_number >= pogosim::kPhotosensorCount) [[unlikely]] {
        pogosim::note_slip({__func__, "sensor_number", "p_B (0, back), p_FL (1, front left) or p_FR (2, front right)",
                            "-1 is returned"},
                           sensor_number);
        return -1;
    }
    if (!context.has_body()) {
        return -1;
    }
    pogosim::World& world = *context.world;
    if (world.lamps.empty()) [[unlikely]] {
        context.services->warn_once(
            "{}(): there is no lamp in this world, so it is dark everywhere; add an object of type static_light or "
            "another lamp to the configuration",
            __func__);
    }
    int level = pogosim::light_at_sensor(world, context.body(), sensor_number) +
                context.controller->photosensor_bias[sensor_number];
    float const noise = context.spec().photosensor_noise_stddev;
    if (noise > 0.0F) {
        level += static_cast<int>(noise * world.robots.stream[context.robot].normal());
    }
    return static_cast<int16_t>(std::clamp<int>(level, INT16_MIN, INT16_MAX));
}

void pogobot_imu_read(float* acc, float* gyro) {
    require_robot(__func__);
    require_argument(acc, __func__, "acc");
    require_argument(gyro, __func__, "gyro");
    pogosim::note_call();
    pogosim::take_back_floating_point();
    std::fill_n(acc, 3, 0.0F);
    std::fill_n(gyro, 3, 0.0F);
    if (!context.has_body()) {
        return;
    }
    Vec2 const acceleration =
        pogosim::acceleration_m_s2(*context.world, context.body(), context.controller->accelerometer);
    acc[0] = std::clamp(acceleration.y, -kMaxAcceleration, kMaxAcceleration);
    acc[1] = std::clamp(acceleration.x, -kMaxAcceleration, kMaxAcceleration);
    gyro[2] = std::clamp(0.0F - pogosim::observed_motion(*context.world, context.body()).angular_velocity_rad_s,
                         -kMaxAngularVelocity, kMaxAngularVelocity);
}

float pogobot_imu_readTemp() {
    require_robot(__func__);
    return std::clamp(context.world->temperature_c, kMinTemperature, kMaxTemperature);
}
