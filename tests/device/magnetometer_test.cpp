// What the magnetometer measures, as functions of plain data.
#include "device/magnetometer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace pogosim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

/// No harmonics, no differences between robots, no noise.
MagnetometerSpec plain_ellipse() {
    MagnetometerSpec spec;
    spec.harmonics.clear();
    spec.variation.noise_stddev = {};
    return spec;
}

Interval fixed(double value) {
    return {value, value};
}

Pose heading(double degrees) {
    return {.position_mm = {0.0F, 0.0F}, .heading_rad = static_cast<float>(degrees * kDegree)};
}

Axes reading(MagnetometerSpec const& spec, Pose const& pose, std::uint32_t id = 0) {
    return noiseless_reading(spec, profile_of(spec, id), pose);
}

/// A turn in steps of 5 degrees.
std::vector<double> turn() {
    std::vector<double> degrees;
    for (int i = 0; i < 72; ++i) {
        degrees.push_back(5.0 * i);
    }
    return degrees;
}

TEST(Magnetometer, TurningInAUniformFieldGivesTheEllipse) {
    MagnetometerSpec spec = plain_ellipse();
    spec.ellipse.rotation_rad = fixed(0.3);
    for (double const degrees : turn()) {
        Axes const m = reading(spec, heading(degrees));
        double const along = std::cos(0.3) * (m[0] - 425.0) + std::sin(0.3) * (m[1] - 425.0);
        double const across = -std::sin(0.3) * (m[0] - 425.0) + std::cos(0.3) * (m[1] - 425.0);
        EXPECT_NEAR(along, 160.0 * std::cos(-degrees * kDegree), 1e-4);
        EXPECT_NEAR(across, 140.0 * std::sin(-degrees * kDegree), 1e-4);
        EXPECT_NEAR(m[2], 425.0 + 15.0 * std::cos(-degrees * kDegree) - 10.0 * std::sin(-degrees * kDegree), 1e-4);
    }
}

TEST(Magnetometer, FieldThatTurnsAndRobotThatTurnsWithItReadTheSame) {
    MagnetometerSpec const north;
    MagnetometerSpec turned;
    turned.field.at_origin = {std::cos(1.0), std::sin(1.0), 0.0};
    for (double const degrees : turn()) {
        Axes const before = reading(north, heading(degrees));
        Axes const after = reading(turned, heading(degrees + 1.0 / kDegree));
        for (std::size_t axis = 0; axis < before.size(); ++axis) {
            EXPECT_NEAR(before[axis], after[axis], 1e-3);
        }
    }
}

TEST(Magnetometer, DefaultCurveHasASecondHarmonic) {
    MagnetometerSpec const spec;
    Axes const m = reading(spec, heading(-30.0));
    Axes const plain = reading(plain_ellipse(), heading(-30.0));
    EXPECT_NEAR(m[0] - plain[0], 12.0 * std::cos(60.0 * kDegree), 1e-4);
    EXPECT_NEAR(m[1] - plain[1], -6.0 * std::cos(60.0 * kDegree) + 4.0 * std::sin(60.0 * kDegree), 1e-4);
    EXPECT_EQ(m[2], plain[2]);
}

TEST(Magnetometer, HarmonicsOfTheSameOrderAddUp) {
    MagnetometerSpec spec = plain_ellipse();
    MagneticHarmonic third{.order = 3, .cosine = {.x = fixed(5.0)}, .sine = {}};
    spec.harmonics = {third, third};
    double const plain = reading(plain_ellipse(), heading(10.0))[0];
    EXPECT_NEAR(reading(spec, heading(10.0))[0] - plain, 10.0 * std::cos(-30.0 * kDegree), 1e-4);
}

TEST(Magnetometer, GradientMakesTheSignalLinearInThePosition) {
    MagnetometerSpec spec = plain_ellipse();
    spec.field.gradient_x = {0.001, 0.0, 0.0};
    spec.field.origin_mm = {100.0F, 50.0F};
    double const at_origin = reading(spec, {.position_mm = {100.0F, 900.0F}, .heading_rad = 0.0F})[0] - 425.0;
    EXPECT_NEAR(at_origin, 160.0, 1e-9);
    for (double const x : {-400.0, 0.0, 350.0, 1100.0}) {
        Pose const pose{.position_mm = {static_cast<float>(x), 0.0F}, .heading_rad = 0.0F};
        EXPECT_NEAR(reading(spec, pose)[0] - 425.0, 160.0 * (1.0 + 0.001 * (x - 100.0)), 1e-6);
    }
    spec.scales_with_field = false;
    EXPECT_NEAR(reading(spec, {.position_mm = {1100.0F, 0.0F}, .heading_rad = 0.0F})[0] - 425.0, 160.0, 1e-9);
}

TEST(Magnetometer, GradientAcrossTheFieldTurnsIt) {
    MagnetometerSpec spec = plain_ellipse();
    spec.field.gradient_y = {0.0, 0.01, 0.0};
    Axes const m = reading(spec, {.position_mm = {0.0F, 100.0F}, .heading_rad = 0.0F});  // the field is (1, 1)
    EXPECT_NEAR(m[0], 425.0 + 160.0 * std::sqrt(2.0) * std::cos(kPi / 4), 1e-6);
    EXPECT_NEAR(m[1], 425.0 + 140.0 * std::sqrt(2.0) * std::sin(kPi / 4), 1e-6);
}

TEST(Magnetometer, FieldWithoutHorizontalPartLeavesTheMiddleOfTheCurve) {
    MagnetometerSpec spec;
    spec.field.at_origin = {0.0, 0.0, 1.0};
    for (double const degrees : turn()) {
        EXPECT_EQ(reading(spec, heading(degrees)), (Axes{425.0, 425.0, 425.0}));
    }
}

TEST(Magnetometer, CalibratedReadingsGiveTheHeadingWithinTheNoise) {
    MagnetometerSpec spec = plain_ellipse();
    spec.variation.noise_stddev = {.x = fixed(3.0), .y = fixed(3.0), .z = fixed(3.0)};
    double squares = 0.0;
    double mean = 0.0;
    constexpr int count = 2000;
    for (int i = 0; i < count; ++i) {
        double const angle = 0.7 * i;
        auto const pose = heading(angle / kDegree);
        MagneticCounts const m = measure_field(spec, 0, static_cast<std::uint64_t>(i), pose);
        double const found = -std::atan2((m[1] - 425.0) / 140.0, (m[0] - 425.0) / 160.0);
        double const error = std::remainder(found - angle, 2.0 * kPi);
        mean += error / count;
        squares += error * error / count;
    }
    // Noise across the ray: between 3 / 160 and 3 / 140 rad, and that of rounding, 1 / sqrt(12) counts.
    double const expected =
        std::sqrt(9.0 + 1.0 / 12.0) * std::sqrt((1.0 / (160.0 * 160.0) + 1.0 / (140.0 * 140.0)) / 2);
    EXPECT_NEAR(std::sqrt(squares), expected, 0.1 * expected);
    EXPECT_NEAR(mean, 0.0, 4.0 * expected / std::sqrt(static_cast<double>(count)));
}

TEST(Magnetometer, RobotsDrawTheirValuesFromTheIntervals) {
    MagnetometerSpec spec = plain_ellipse();
    spec.variation.additional_bias = {.x = {-15.0, 15.0}, .y = fixed(7.0), .z = {}};
    spec.variation.signal_gain = {0.95, 1.05};
    double least = 1e9;
    double most = -1e9;
    for (std::uint32_t id = 0; id < 200; ++id) {
        MagnetometerProfile const profile = profile_of(spec, id);
        least = std::min(least, profile.curve.constant[0]);
        most = std::max(most, profile.curve.constant[0]);
        EXPECT_EQ(profile.curve.constant[1], 432.0);
        EXPECT_GE(profile.gain, 0.95);
        EXPECT_LT(profile.gain, 1.05);
    }
    EXPECT_GE(least, 410.0);
    EXPECT_LT(least, 411.0);
    EXPECT_LT(most, 440.0);
    EXPECT_GT(most, 439.0);
}

TEST(Magnetometer, GainMultipliesTheSignalAndNotTheCentre) {
    MagnetometerSpec spec = plain_ellipse();
    spec.variation.signal_gain = fixed(1.1);
    EXPECT_NEAR(reading(spec, heading(0.0))[0], 425.0 + 176.0, 1e-9);
}

TEST(Magnetometer, OffsetsOfTheAngleTurnTheReadings) {
    MagnetometerSpec spec = plain_ellipse();
    spec.variation.angle_offset_rad = fixed(0.5);
    spec.ellipse.phase_offset_rad = fixed(0.25);
    Axes const m = reading(spec, heading(0.75 / kDegree));
    EXPECT_NEAR(m[0], 585.0, 1e-4);
    EXPECT_NEAR(m[1], 425.0, 1e-4);
}

TEST(Magnetometer, AnotherIntervalOfOneValueLeavesTheOthers) {
    MagnetometerSpec spec;
    spec.variation.additional_bias = {.x = {-15.0, 15.0}, .y = {-15.0, 15.0}, .z = {-15.0, 15.0}};
    MagnetometerProfile const before = profile_of(spec, 3);
    spec.variation.signal_gain = {0.5, 1.5};
    spec.ellipse.major_radius = {100.0, 200.0};
    MagnetometerProfile const after = profile_of(spec, 3);
    EXPECT_EQ(before.curve.constant, after.curve.constant);
    EXPECT_NE(before.gain, after.gain);
    EXPECT_NE(before.curve.cosine[0], after.curve.cosine[0]);
}

TEST(Magnetometer, SampleDependsOnSeedRobotAndNumberAlone) {
    MagnetometerSpec spec;
    spec.seed = 5;
    Pose const pose = heading(20.0);
    MagneticCounts const first = measure_field(spec, 1, 0, pose);
    EXPECT_EQ(first, measure_field(spec, 1, 0, pose));
    EXPECT_NE(first, measure_field(spec, 1, 1, pose));
    EXPECT_NE(first, measure_field(spec, 2, 0, pose));
    spec.seed = 6;
    EXPECT_NE(first, measure_field(spec, 1, 0, pose));
}

TEST(Magnetometer, NoiseHasTheDeviationOfEachAxis) {
    MagnetometerSpec spec = plain_ellipse();
    spec.output.quantization_step = 0.0;
    spec.variation.noise_stddev = {.x = fixed(20.0), .y = fixed(40.0), .z = {}};
    constexpr int count = 4000;
    Axes sum{};
    for (int i = 0; i < count; ++i) {
        MagneticCounts const m = measure_field(spec, 0, static_cast<std::uint64_t>(i), heading(0.0));
        sum[0] += (m[0] - 585.0) * (m[0] - 585.0) / count;
        sum[1] += (m[1] - 425.0) * (m[1] - 425.0) / count;
        EXPECT_EQ(m[2], 440);
    }
    EXPECT_NEAR(std::sqrt(sum[0]), 20.0, 1.0);
    EXPECT_NEAR(std::sqrt(sum[1]), 40.0, 2.0);
}

TEST(Magnetometer, CountsAreMultiplesOfTheStep) {
    MagnetometerOutput output;
    EXPECT_EQ(counts_of(output, {1.4, 1.5, -1.5}), (MagneticCounts{1, 2, -2}));
    output.quantization_step = 4.0;
    EXPECT_EQ(counts_of(output, {5.9, 6.0, -6.1}), (MagneticCounts{4, 8, -8}));
    output.quantization_step = -1.0;
    EXPECT_EQ(counts_of(output, {5.4, 5.6, -6.6}), (MagneticCounts{5, 6, -7}));
}

TEST(Magnetometer, CountsAreClampedAndNeverLeave16Bits) {
    MagnetometerOutput output;
    EXPECT_EQ(counts_of(output, {1e6, -1e6, 32767.4}), (MagneticCounts{32767, -32768, 32767}));
    output.clamp = true;
    output.limits.y = {-10.0, 10.0};
    EXPECT_EQ(counts_of(output, {0.0, 11.0, 601.0}), (MagneticCounts{250, 10, 600}));
}

TEST(Magnetometer, DomainAllowsClampsOrRefuses) {
    MagneticDomain domain;
    domain.x_mm = {-100.0, 100.0};
    Pose const outside{.position_mm = {150.0F, 7.0F}, .heading_rad = 1.0F};
    EXPECT_EQ(pose_in_domain(domain, outside)->position_mm, outside.position_mm);
    domain.policy = DomainPolicy::clamp;
    Pose const clamped = *pose_in_domain(domain, outside);
    EXPECT_EQ(clamped.position_mm, (Vec2{100.0F, 7.0F}));
    EXPECT_EQ(clamped.heading_rad, 1.0F);
    domain.policy = DomainPolicy::refuse;
    EXPECT_FALSE(pose_in_domain(domain, outside));
    EXPECT_TRUE(pose_in_domain(domain, {.position_mm = {100.0F, 1e6F}, .heading_rad = 0.0F}));
}

TEST(Magnetometer, HeadingsCountModuloATurnUnlessAskedOtherwise) {
    MagneticDomain domain;
    domain.policy = DomainPolicy::refuse;
    domain.heading_rad = {0.0, 2.0 * kPi};
    EXPECT_TRUE(pose_in_domain(domain, heading(-90.0)));
    domain.wrap_heading = false;
    EXPECT_FALSE(pose_in_domain(domain, heading(-90.0)));
}

TEST(Magnetometer, HeadingIsClampedToTheNearerEndOfItsDomain) {
    MagneticDomain domain;
    domain.policy = DomainPolicy::clamp;
    domain.heading_rad = {0.0, 90.0 * kDegree};
    EXPECT_NEAR(pose_in_domain(domain, heading(100.0))->heading_rad, 90.0 * kDegree, 1e-6);
    EXPECT_NEAR(pose_in_domain(domain, heading(-10.0))->heading_rad, 0.0, 1e-6);
    EXPECT_NEAR(pose_in_domain(domain, heading(45.0))->heading_rad, 45.0 * kDegree, 1e-6);
    domain.wrap_heading = false;
    EXPECT_NEAR(pose_in_domain(domain, heading(100.0))->heading_rad, 90.0 * kDegree, 1e-6);
    EXPECT_NEAR(pose_in_domain(domain, heading(-10.0))->heading_rad, 0.0, 1e-6);
}

TEST(Magnetometer, RobotThatPollsWaitsForTheNextDataOrTheEndOfItsTime) {
    auto const poll = [](std::int64_t clock_us, std::int64_t taken, std::uint16_t timeout_ms) {
        MagnetometerPoll const found = poll_magnetometer(clock_us, taken, timeout_ms);
        return std::pair(found.finds_data, found.wait_us);
    };
    EXPECT_EQ(poll(0, 0, 0), std::pair(false, std::int64_t{0}));  // it does not look at all
    EXPECT_EQ(poll(45000, 1, 0), std::pair(false, std::int64_t{0}));
    EXPECT_EQ(poll(45000, 1, 1), std::pair(true, std::int64_t{0}));  // data of 40 ms
    EXPECT_EQ(poll(45000, 2, 10), std::pair(false, std::int64_t{10000}));
    EXPECT_EQ(poll(45000, 2, 15), std::pair(false, std::int64_t{15000}));  // the last poll is 14 ms later
    EXPECT_EQ(poll(45000, 2, 16), std::pair(true, std::int64_t{15000}));
    EXPECT_EQ(poll(45300, 2, 50), std::pair(true, std::int64_t{15000}));
    EXPECT_EQ(data_number(19999), 0);
    EXPECT_EQ(data_number(20000), 1);
}

}  // namespace
}  // namespace pogosim
