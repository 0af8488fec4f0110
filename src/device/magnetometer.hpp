// What the magnetometers of robots measure: functions of the configuration, the robot's id, its pose, and how often it
// has measured before. With position (x, y), heading h and values that each robot draws once from the intervals of the
// configuration:
//
//     B(x, y) = B0 + Gx (x - x0) + Gy (y - y0)          the field
//     a       = atan2(By, Bx) - h + angle offset        its angle in the robot's frame
//     s       = |B_xy| / |B0_xy|, or 1                  the strength of the signal
//     m       = bias + curve.constant + gain s sum_k (C_k cos(k a) + S_k sin(k a)) + noise
//
// then rounded, limited, and rounded to 16 bits. docs/magnetometer.md explains it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "world/magnetometer_spec.hpp"
#include "world/world.hpp"

namespace pogosim {

using MagneticCounts = std::array<std::int16_t, kAxisCount>;

/// What one robot has drawn.
struct MagnetometerProfile {
    MagneticCurve curve;
    double gain = 1.0;
    double angle_offset_rad = 0.0;
    Axes noise_stddev{};
};

/// The profile of the robot with this id. Each value has its own place in the robot's random stream: another width of
/// one interval changes no other value.
MagnetometerProfile profile_of(MagnetometerSpec const& spec, std::uint32_t id);

Axes field_at(MagneticField const& field, Vec2 position_mm);

/// The pose for which the model is evaluated: clamped if the domain says so; nothing if it refuses this one.
std::optional<Pose> pose_in_domain(MagneticDomain const& domain, Pose pose);

/// The reading without noise and rounding.
Axes noiseless_reading(MagnetometerSpec const& spec, MagnetometerProfile const& profile, Pose const& pose);

/// A reading as the sensor shows it.
MagneticCounts counts_of(MagnetometerOutput const& output, Axes const& reading);

/// The sample with this number, from 0, of the robot with this id.
MagneticCounts measure_field(MagnetometerSpec const& spec, std::uint32_t id, std::uint64_t sample, Pose const& pose);

/// Whether a robot has a magnetometer that its program finds.
bool has_magnetometer(World const& world, std::uint32_t robot);

/// The next sample of a robot that has one, at its pose; nothing if the configuration refuses this pose.
std::optional<MagneticCounts> read_magnetometer(World& world, std::uint32_t robot);

/// The pose at which it measures.
Pose magnetometer_pose(World const& world, std::uint32_t robot);

/// What is said of a pose that the configuration refuses, ended by a zero: code of users that is left must own nothing.
std::array<char, 256> refused_pose_text(Pose const& pose);

/// Waiting for data that are new 50 times per second of the robot's clock, by looking once a millisecond.
struct MagnetometerPoll {
    std::int64_t wait_us = 0;  // until the data are found, or the time is over
    bool finds_data = false;
};

/// `taken`: data_number() of the data read last.
MagnetometerPoll poll_magnetometer(std::int64_t clock_us, std::int64_t taken, std::uint16_t timeout_ms);

/// The data that the sensor has at this time; 0: none yet.
std::int64_t data_number(std::int64_t clock_us);

}  // namespace pogosim
