#include "device/magnetometer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/exact_math.hpp"
#include "base/random.hpp"

namespace pogosim {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr std::int64_t kDataPeriodUs = 20000;  // 50 Hz
constexpr std::int64_t kPollUs = 1000;

// Tags that keep these random streams apart from all other streams of the run.
constexpr std::uint64_t kProfiles = 0x6d61676e70726f66ULL;
constexpr std::uint64_t kSamples = 0x6d61676e73616d70ULL;

std::uint64_t seed_for(std::uint64_t purpose, std::uint64_t seed, std::uint32_t id) {
    return mix64(purpose ^ mix64(seed)) + id;
}

double draw(Interval const& interval, RandomStream& stream) {
    return interval.min + (interval.max - interval.min) * static_cast<double>(stream.uniform());
}

Axes draw(AxisIntervals const& intervals, RandomStream& stream) {
    double const x = draw(intervals.x, stream);
    double const y = draw(intervals.y, stream);
    double const z = draw(intervals.z, stream);
    return {x, y, z};
}

void add(Axes& to, Axes const& values, double factor = 1.0) {
    for (std::size_t axis = 0; axis < to.size(); ++axis) {
        to[axis] += factor * values[axis];
    }
}

/// The ellipse is the first harmonic of its x and y.
void add_ellipse(MagneticEllipse const& ellipse, RandomStream& stream, MagnetometerProfile& profile) {
    add(profile.curve.constant, draw(ellipse.centre, stream));
    double const major = draw(ellipse.major_radius, stream);
    double const minor = draw(ellipse.minor_radius, stream);
    auto const [sine, cosine] = exact::sine_cosine(draw(ellipse.rotation_rad, stream));
    profile.angle_offset_rad += draw(ellipse.phase_offset_rad, stream);
    double const z_cosine = draw(ellipse.z_cosine, stream);
    double const z_sine = draw(ellipse.z_sine, stream);
    profile.curve.cosine[0] = {major * cosine, major * sine, z_cosine};
    profile.curve.sine[0] = {-minor * sine, minor * cosine, z_sine};
    profile.curve.order = 1;
}

void add_harmonics(std::vector<MagneticHarmonic> const& harmonics, RandomStream& stream, MagneticCurve& curve) {
    for (MagneticHarmonic const& harmonic : harmonics) {
        auto const index = static_cast<std::size_t>(harmonic.order - 1);
        add(curve.cosine[index], draw(harmonic.cosine, stream));
        add(curve.sine[index], draw(harmonic.sine, stream));
        curve.order = std::max(curve.order, harmonic.order);
    }
}

double horizontal(Axes const& field) {
    return std::sqrt(field[0] * field[0] + field[1] * field[1]);
}

double strength(MagnetometerSpec const& spec, Axes const& field) {
    constexpr double kLeast = 1e-12;
    return spec.scales_with_field ? horizontal(field) / std::max(horizontal(spec.field.at_origin), kLeast) : 1.0;
}

bool is_inside(std::optional<Interval> const& interval, double value) {
    return !interval || (value >= interval->min && value <= interval->max);
}

/// The same angle at or above `from`, by less than a turn.
double wrapped_above(double from, double angle) {
    return angle - kTurn * std::floor((angle - from) / kTurn);
}

/// The nearest value of the interval. A heading that wraps must lie between the interval's minimum and one turn above
/// it.
double nearest(std::optional<Interval> const& interval, double value, bool wraps) {
    if (is_inside(interval, value)) {
        return value;
    }
    bool const is_nearer_round = wraps && interval->min + kTurn - value < value - interval->max;
    return is_nearer_round ? interval->min : std::clamp(value, interval->min, interval->max);
}

}  // namespace

MagnetometerProfile profile_of(MagnetometerSpec const& spec, std::uint32_t id) {
    RandomStream stream(seed_for(kProfiles, spec.seed, id), id);
    MagnetometerProfile profile;
    Axes const bias = draw(spec.variation.additional_bias, stream);
    profile.gain = draw(spec.variation.signal_gain, stream);
    profile.angle_offset_rad = draw(spec.variation.angle_offset_rad, stream);
    profile.noise_stddev = draw(spec.variation.noise_stddev, stream);
    if (spec.fitted) {
        profile.curve = *spec.fitted;
    } else {
        add_ellipse(spec.ellipse, stream, profile);
        add_harmonics(spec.harmonics, stream, profile.curve);
    }
    add(profile.curve.constant, bias);
    return profile;
}

Axes field_at(MagneticField const& field, Vec2 position_mm) {
    Axes here = field.at_origin;
    add(here, field.gradient_x, static_cast<double>(position_mm.x) - field.origin_mm.x);
    add(here, field.gradient_y, static_cast<double>(position_mm.y) - field.origin_mm.y);
    return here;
}

std::optional<Pose> pose_in_domain(MagneticDomain const& domain, Pose pose) {
    if (domain.policy == DomainPolicy::allow) {
        return pose;
    }
    bool const wraps = domain.wrap_heading && domain.heading_rad;
    double const x = pose.position_mm.x;
    double const y = pose.position_mm.y;
    double const heading =
        wraps ? wrapped_above(domain.heading_rad->min, pose.heading_rad) : static_cast<double>(pose.heading_rad);
    if (is_inside(domain.x_mm, x) && is_inside(domain.y_mm, y) && is_inside(domain.heading_rad, heading)) {
        return pose;
    }
    if (domain.policy == DomainPolicy::refuse) {
        return std::nullopt;
    }
    return Pose{.position_mm = {static_cast<float>(nearest(domain.x_mm, x, false)),
                                static_cast<float>(nearest(domain.y_mm, y, false))},
                .heading_rad = static_cast<float>(nearest(domain.heading_rad, heading, wraps))};
}

Axes noiseless_reading(MagnetometerSpec const& spec, MagnetometerProfile const& profile, Pose const& pose) {
    Axes const field = field_at(spec.field, pose.position_mm);
    double const angle = exact::atan2(field[1], field[0]) - pose.heading_rad + profile.angle_offset_rad;
    double const factor = profile.gain * strength(spec, field);
    Axes reading = profile.curve.constant;
    for (int k = 1; k <= profile.curve.order; ++k) {
        auto const [sine, cosine] = exact::sine_cosine(k * angle);
        auto const index = static_cast<std::size_t>(k - 1);
        add(reading, profile.curve.cosine[index], factor * cosine);
        add(reading, profile.curve.sine[index], factor * sine);
    }
    return reading;
}

MagneticCounts counts_of(MagnetometerOutput const& output, Axes const& reading) {
    using Count = std::numeric_limits<std::int16_t>;
    auto const limits = output.limits.all();
    MagneticCounts counts{};
    for (std::size_t axis = 0; axis < counts.size(); ++axis) {
        double value = reading[axis];
        if (output.quantization_step > 0.0) {
            value = output.quantization_step * std::round(value / output.quantization_step);
        }
        if (output.clamp) {
            value = std::clamp(value, limits[axis].min, limits[axis].max);
        }
        counts[axis] = static_cast<std::int16_t>(std::clamp<double>(std::round(value), Count::min(), Count::max()));
    }
    return counts;
}

MagneticCounts measure_field(MagnetometerSpec const& spec, std::uint32_t id, std::uint64_t sample, Pose const& pose) {
    MagnetometerProfile const profile = profile_of(spec, id);
    Axes reading = noiseless_reading(spec, profile, pose);
    RandomStream noise(seed_for(kSamples, spec.seed, id), sample);
    for (std::size_t axis = 0; axis < reading.size(); ++axis) {
        reading[axis] += profile.noise_stddev[axis] * static_cast<double>(noise.normal());
    }
    return counts_of(spec.output, reading);
}

bool has_magnetometer(World const& world, std::uint32_t robot) {
    RobotSpec const& spec = world.spec_of(robot);
    return world.robots.body[robot] != kNone && spec.model.has_magnetometer && spec.magnetometer_enabled;
}

Pose magnetometer_pose(World const& world, std::uint32_t robot) {
    std::uint32_t const body = world.robots.body[robot];
    return {.position_mm = wrapped(world, world.bodies.position_mm[body]),
            .heading_rad = world.bodies.heading_rad[body]};
}

std::optional<MagneticCounts> read_magnetometer(World& world, std::uint32_t robot) {
    auto const inside = pose_in_domain(world.magnetometer.domain, magnetometer_pose(world, robot));
    if (!inside) {
        return std::nullopt;
    }
    Magnetometer& self = world.devices.magnetometer[robot];
    self.last = measure_field(world.magnetometer, world.robots.id[robot], self.samples, *inside);
    ++self.samples;
    self.taken = data_number(world.devices.clock_us[robot]);
    return self.last;
}

std::array<char, 256> refused_pose_text(Pose const& pose) {
    constexpr double degrees = 180.0 / std::numbers::pi;
    std::array<char, 256> text{};
    fmt::format_to_n(
        text.data(), text.size() - 1,
        "magn_read_XYZ(): the pose x {:.1f} mm, y {:.1f} mm, heading {:.1f} degrees is outside magnetometer.domain, "
        "whose policy is throw",
        pose.position_mm.x, pose.position_mm.y, pose.heading_rad * degrees);
    return text;
}

MagnetometerPoll poll_magnetometer(std::int64_t clock_us, std::int64_t taken, std::uint16_t timeout_ms) {
    std::int64_t const found_us = std::max(clock_us, (taken + 1) * kDataPeriodUs);
    std::int64_t const polls_before = (found_us - clock_us + kPollUs - 1) / kPollUs;
    bool const finds_data = polls_before < timeout_ms;  // the first poll is at once
    return {.wait_us = kPollUs * (finds_data ? polls_before : timeout_ms), .finds_data = finds_data};
}

std::int64_t data_number(std::int64_t clock_us) {
    return clock_us / kDataPeriodUs;
}

}  // namespace pogosim
