// The magnetometers of robots, as far as the configuration says what they are like: the same for all. The formulas are
// in robot/magnetometer.hpp. Magnetic field in any unit, for only ratios count; readings in counts of the sensor;
// angles in the frame of the world, clockwise on the screen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/vec2.hpp"

namespace pogosim {

inline constexpr int kAxisCount = 3;
using Axes = std::array<double, kAxisCount>;  // x, y, z

/// What each robot draws a number from, or a sensor may show.
struct Interval {
    double min = 0.0;
    double max = 0.0;

    friend bool operator==(Interval const&, Interval const&) = default;
};

struct AxisIntervals {
    Interval x{};
    Interval y{};
    Interval z{};

    std::array<Interval, kAxisCount> all() const { return {x, y, z}; }

    friend bool operator==(AxisIntervals const&, AxisIntervals const&) = default;
};

/// A field that is linear in the place.
struct MagneticField {
    Axes at_origin{1.0, 0.0, 0.0};
    Axes gradient_x{};  // per mm
    Axes gradient_y{};
    Vec2 origin_mm{};

    friend bool operator==(MagneticField const&, MagneticField const&) = default;
};

enum class DomainPolicy { allow, clamp, refuse };

/// Poses for which the model is meant; absent: any.
struct MagneticDomain {
    std::optional<Interval> x_mm{};
    std::optional<Interval> y_mm{};
    std::optional<Interval> heading_rad{};
    bool wrap_heading = true;  // headings count modulo a turn
    DomainPolicy policy = DomainPolicy::allow;

    friend bool operator==(MagneticDomain const&, MagneticDomain const&) = default;
};

struct MagnetometerOutput {
    double quantization_step = 1.0;  // counts; 0 or less: none
    bool clamp = false;
    AxisIntervals limits{.x = {250.0, 600.0}, .y = {250.0, 600.0}, .z = {250.0, 600.0}};

    friend bool operator==(MagnetometerOutput const&, MagnetometerOutput const&) = default;
};

/// What differs from robot to robot.
struct MagnetometerVariation {
    AxisIntervals additional_bias{};  // counts
    Interval signal_gain{1.0, 1.0};
    Interval angle_offset_rad{};
    AxisIntervals noise_stddev{.x = {3.0, 3.0}, .y = {3.0, 3.0}, .z = {3.0, 3.0}};  // counts

    friend bool operator==(MagnetometerVariation const&, MagnetometerVariation const&) = default;
};

inline constexpr int kHighestHarmonic = 32;

struct MagneticHarmonic {
    int order = 2;  // 2 to kHighestHarmonic
    AxisIntervals cosine{};
    AxisIntervals sine{};

    friend bool operator==(MagneticHarmonic const&, MagneticHarmonic const&) = default;
};

/// The curve that readings describe as a robot turns, drawn by each robot.
struct MagneticEllipse {
    AxisIntervals centre{.x = {425.0, 425.0}, .y = {425.0, 425.0}, .z = {425.0, 425.0}};
    Interval major_radius{160.0, 160.0};
    Interval minor_radius{140.0, 140.0};
    Interval rotation_rad{};
    Interval phase_offset_rad{};
    Interval z_cosine{15.0, 15.0};
    Interval z_sine{-10.0, -10.0};

    friend bool operator==(MagneticEllipse const&, MagneticEllipse const&) = default;
};

/// Readings by the angle a of the field in the robot's frame: constant + sum of cosine[k-1] cos ka + sine[k-1] sin ka.
struct MagneticCurve {
    Axes constant{};
    int order = 0;  // how many harmonics are in use
    std::array<Axes, kHighestHarmonic> cosine{};
    std::array<Axes, kHighestHarmonic> sine{};

    friend bool operator==(MagneticCurve const&, MagneticCurve const&) = default;
};

enum class MagnetometerTiming {
    at_once,  // each call measures
    robot,    // new data at 50 Hz, waited for as on the robot
};

inline constexpr MagneticHarmonic kUsualHarmonic{
    .order = 2, .cosine = {.x = {12.0, 12.0}, .y = {-6.0, -6.0}, .z = {}}, .sine = {.x = {}, .y = {4.0, 4.0}, .z = {}}};

struct MagnetometerSpec {
    std::uint64_t seed = 0;  // of profiles and noise
    MagnetometerTiming timing = MagnetometerTiming::at_once;
    bool scales_with_field = true;  // the signal is proportional to the horizontal field
    MagneticField field;
    MagneticDomain domain;
    MagnetometerOutput output;
    MagnetometerVariation variation;
    MagneticEllipse ellipse;
    std::vector<MagneticHarmonic> harmonics = std::vector(1, kUsualHarmonic);
    std::optional<MagneticCurve> fitted{};  // to a table: instead of the ellipse and the harmonics

    friend bool operator==(MagnetometerSpec const&, MagnetometerSpec const&) = default;
};

}  // namespace pogosim
