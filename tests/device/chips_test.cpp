// What the chips of a real robot make of a quantity.
#include "device/chips.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "device/sensors.hpp"

namespace pogosim {
namespace {

ImuReading at_rest(SensorSpec const& spec) {
    RandomStream noise(1, 2);
    return imu_reading(spec, {}, 0.0F, noise);
}

TEST(Chips, CountsAreTheNearestMultiplesOfTheirStep) {
    EXPECT_EQ(in_counts(0.0F, kAccelerationStep), 0.0F);
    EXPECT_EQ(in_counts(0.4F * kAccelerationStep, kAccelerationStep), 0.0F);
    EXPECT_EQ(in_counts(0.6F * kAccelerationStep, kAccelerationStep), kAccelerationStep);
    EXPECT_EQ(in_counts(-2.6F * kAngularVelocityStep, kAngularVelocityStep), -3.0F * kAngularVelocityStep);
    for (float const value : {-123.4F, -0.01F, 0.02F, 1.0F, 99.9F}) {
        EXPECT_NEAR(in_counts(value, kAccelerationStep), value, 0.5001F * kAccelerationStep);
    }
}

TEST(Chips, CountsHave16Bits) {
    EXPECT_EQ(in_counts(1e6F, kAccelerationStep), 32767.0F * kAccelerationStep);
    EXPECT_EQ(in_counts(-1e6F, kAccelerationStep), -32768.0F * kAccelerationStep);
    // The ranges of the chip are those of 16 bits.
    EXPECT_NEAR(32768.0F * kAccelerationStep, kMaxAcceleration, 0.01F);
    EXPECT_NEAR(32768.0F * kAngularVelocityStep, kMaxAngularVelocity, 0.001F);
}

TEST(Chips, ConverterOf10BitsGives1023ForTheBrightestLight) {
    EXPECT_EQ(converted_light(32767, 10), 1023);
    EXPECT_EQ(converted_light(16384, 10), 512);
    EXPECT_EQ(converted_light(32, 10), 1);
    EXPECT_EQ(converted_light(31, 10), 0);
    EXPECT_EQ(converted_light(-500, 10), 0);      // no converter gives less
    EXPECT_EQ(converted_light(40000, 10), 1023);  // or more
    EXPECT_EQ(converted_light(32767, 1), 1);
    EXPECT_EQ(converted_light(16383, 1), 0);
}

TEST(Chips, LightOf15BitsIsWhatItIsInTheWorld) {
    for (int const level : {-500, 0, 1, 12345, 32767, 40000}) {
        EXPECT_EQ(converted_light(level, kLightBits), level);
    }
}

TEST(Chips, ThermometerOfARobotHasStepsOfItsCounts) {
    EXPECT_EQ(thermometer_c(25.0F, SensorModel::ideal), 25.0F);
    EXPECT_EQ(thermometer_c(200.0F, SensorModel::robot), thermometer_c(85.0F, SensorModel::robot));
    for (float const temperature : {-40.0F, 0.0F, 21.0F, 25.0F, 42.0F, 85.0F}) {
        float const read = thermometer_c(temperature, SensorModel::robot);
        EXPECT_NEAR(read, temperature, 0.5F / kTemperatureCountsPerC + 1e-5F);
        float const counts = (read - 21.0F) * kTemperatureCountsPerC + 21.0F;
        EXPECT_NEAR(counts, std::round(counts), 0.01F);
    }
}

TEST(Chips, VoltmeterOfARobotHasStepsOf6445Microvolts) {
    EXPECT_EQ(voltmeter_mv(4200.0, SensorModel::ideal), 4200);
    EXPECT_EQ(voltmeter_mv(4200.0, SensorModel::robot), 4195);  // 651 counts
    EXPECT_EQ(voltmeter_mv(3000.0, SensorModel::robot), 2996);  // 465 counts
    EXPECT_EQ(voltmeter_mv(1e5, SensorModel::robot), 6593);     // 1023 counts
}

TEST(Chips, AccelerometerFeelsGravityAtRestAndNothingInFreeFall) {
    EXPECT_FLOAT_EQ(felt_upwards_m_s2(0.0F, true), kGravity);
    EXPECT_FLOAT_EQ(felt_upwards_m_s2(-kGravity, true), 0.0F);
    EXPECT_FLOAT_EQ(felt_upwards_m_s2(-1.0F, false), -1.0F);
    EXPECT_FLOAT_EQ(at_rest({.imu_gravity = true}).acceleration[2], kGravity);
    EXPECT_EQ(at_rest({}).acceleration[2], 0.0F);
    EXPECT_EQ(at_rest({.imu_gravity = true}).acceleration[0], 0.0F);
}

TEST(Chips, ReadingsInWholeCountsAreMultiplesOfTheSteps) {
    RandomStream noise(1, 2);
    ImuReading const reading =
        imu_reading({.imu_gravity = true, .imu_quantization = true}, {1.0F, -0.123F}, 0.7F, noise);
    EXPECT_FLOAT_EQ(reading.acceleration[1], 209.0F * kAccelerationStep);  // 1 / 0.0047886 = 208.8
    EXPECT_FLOAT_EQ(reading.acceleration[0], -26.0F * kAccelerationStep);
    EXPECT_FLOAT_EQ(reading.acceleration[2], 2048.0F * kAccelerationStep);  // g
    EXPECT_FLOAT_EQ(reading.angular_velocity[2], -657.0F * kAngularVelocityStep);
    EXPECT_EQ(noise, RandomStream(1, 2));  // without noise, nothing is drawn
}

TEST(Chips, NoiseHasItsStandardDeviationOnEachAxis) {
    constexpr int count = 4000;
    SensorSpec const spec{.acceleration_noise_m_s2 = 0.5F, .angular_noise_rad_s = 0.02F};
    RandomStream noise(3, 4);
    double of_acceleration = 0.0;
    double of_turning = 0.0;
    for (int i = 0; i < count; ++i) {
        ImuReading const reading = imu_reading(spec, {}, 0.0F, noise);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            of_acceleration += std::pow(reading.acceleration[axis], 2.0);
            of_turning += std::pow(reading.angular_velocity[axis], 2.0);
        }
    }
    EXPECT_NEAR(std::sqrt(of_acceleration / (3 * count)), 0.5, 0.015);
    EXPECT_NEAR(std::sqrt(of_turning / (3 * count)), 0.02, 0.0006);
}

TEST(Chips, OriginalAccelerationIsInDecimetres) {
    RandomStream noise(1, 2);
    SensorSpec const spec{.imu_gravity = true, .acceleration = ImuAcceleration::original};
    ImuReading const reading = imu_reading(spec, {1.5F, -0.5F}, 2.0F, noise);
    EXPECT_FLOAT_EQ(reading.acceleration[0], -5.0F);
    EXPECT_FLOAT_EQ(reading.acceleration[1], 15.0F);
    EXPECT_FLOAT_EQ(reading.acceleration[2], 10.0F * kGravity);
    EXPECT_FLOAT_EQ(reading.angular_velocity[2], -2.0F);
}

}  // namespace
}  // namespace pogosim
