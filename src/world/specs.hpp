// Parameters that are fixed for a whole run: the parts of walls and of the objects of each category, from the
// configuration. Their defaults are here; those of shapes are in geometry/shape.hpp, those of formations in
// geometry/formation.hpp, and those of the run itself in config/scenario.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "geometry/shape.hpp"
#include "world/brain_spec.hpp"
#include "world/lamp_spec.hpp"
#include "world/robot_model.hpp"

namespace pogosim {

/// The outline of a Pogobot: what a `pogobot` is without `geometry` and `radius`.
inline Shape const kPogobotShape{.kind = ShapeKind::disk, .radius_mm = 26.5F};

/// Rigid-body parameters.
struct BodySpec {
    float linear_damping = 0.0F;   // 1/s
    float angular_damping = 0.0F;  // 1/s
    float density = 10.0F;         // mass per (100 mm)^2, > 0
    float friction = 0.3F;         // Coulomb coefficient; two bodies: geometric mean
    float restitution = 0.5F;      // 0 to 1; two bodies: the larger
    bool fixed = false;            // never moves
    bool blocks_infrared = false;  // messages do not pass
    bool blocks_light = true;      // throws shadows in the light of lamps that cast them

    friend bool operator==(BodySpec const&, BodySpec const&) = default;
};

/// No wall makes a body faster than this, mm/s.
inline constexpr float kMostBounceMmS = 10000.0F;

/// The walls of a solid arena.
struct WallSpec {
    float friction = 0.05F;       // Coulomb coefficient
    float restitution = 0.5F;     // 0 to 1; above 1, walls add energy
    bool block_infrared = false;  // messages do not pass
    bool block_light = true;      // they throw shadows in the light of lamps that cast them
};

enum class ReceptionLaw {
    constant,  // P = rate
    article,   // P = 1 / (alpha + beta p^gamma c^delta exp(zeta m) + theta p c), the article's equation
    power,     // P = 1 / (1 + alpha m^beta p^gamma c^delta), the older four-parameter law
};

/// Probability that one receiver gets a message of m bytes, sent with probability p per tick in a cluster of c robots.
struct ReceptionSpec {
    ReceptionLaw law = ReceptionLaw::article;
    double rate = 0.9;
    // The article's fit to the measurements on real robots (R2 = 0.914975).
    double alpha = 1.03215183;
    double beta = 0.00073859;
    double gamma = 3.14782227;
    double delta = 3.52543753;
    double zeta = 0.05720136;
    double theta = 0.001;

    friend bool operator==(ReceptionSpec const&, ReceptionSpec const&) = default;
};

/// The older four-parameter law with its own parameters, `type: realistic`.
inline ReceptionSpec four_parameter_law() {
    return {.law = ReceptionLaw::power, .alpha = 4.0e-6, .beta = 2.8096, .gamma = 2.3807, .delta = 1.2457};
}

/// Infrared link of one category of robots.
struct IrSpec {
    float range_mm = 80.0F;  // from an emitter to the receiver's border; 0: mute
    ReceptionSpec reception;
    int queue_size = 20;  // messages a robot's FIFO holds; the newest is dropped when it is full
    std::optional<std::array<float, 3>> range_by_power_mm{};  // at emitter powers 1 to 3; absent: range_mm at all

    float longest_range_mm() const {
        return range_by_power_mm
                   ? std::max({range_mm, (*range_by_power_mm)[0], (*range_by_power_mm)[1], (*range_by_power_mm)[2]})
                   : range_mm;
    }

    /// Range at an emitter power of 0 to 3; at 0 nothing is sent.
    float range_at_mm(std::uint8_t power) const {
        if (power == 0) {
            return 0.0F;
        }
        return range_by_power_mm ? (*range_by_power_mm)[power - 1U] : range_mm;
    }

    friend bool operator==(IrSpec const&, IrSpec const&) = default;
};

struct IntRange {
    int min = 0;
    int max = 0;

    friend bool operator==(IntRange const&, IntRange const&) = default;
};

enum class SensorModel {
    ideal,  // exact numbers
    robot,  // what the chips of a real robot can tell
};

/// The acceleration that a program reads.
enum class ImuAcceleration {
    robot,     // m/s2, between the last two ticks
    original,  // dm/s2, over the last physics step, as in the original simulator
};

inline constexpr int kLightBits = 15;  // of the levels of light in the world, 0 to 32767

/// What a robot's sensors make of the world.
struct SensorSpec {
    SensorModel model = SensorModel::ideal;  // of the defaults, of the thermometer and of the battery's voltage
    int photosensor_bits = kLightBits;       // of the converter of the light sensors
    bool imu_gravity = false;                // the accelerometer feels gravity
    bool imu_quantization = false;           // accelerometer and gyroscope give whole counts
    float acceleration_noise_m_s2 = 0.0F;    // standard deviation, per reading and axis
    float angular_noise_rad_s = 0.0F;        // of the gyroscope: standard deviation, per reading and axis
    ImuAcceleration acceleration = ImuAcceleration::robot;

    friend bool operator==(SensorSpec const&, SensorSpec const&) = default;
};

/// The sensors of a real robot: constants of its library, and the noise of the ICM-20689 by its data sheet
/// (DS-000143): 150 ug and 0.006 degrees per second per root of Hz, behind a low-pass filter of 218 Hz.
inline constexpr SensorSpec kRobotSensors{.model = SensorModel::robot,
                                          .photosensor_bits = 10,
                                          .imu_gravity = true,
                                          .imu_quantization = true,
                                          .acceleration_noise_m_s2 = 0.0217F,
                                          .angular_noise_rad_s = 0.00155F};

/// A battery that empties. Currents in mA.
struct BatterySpec {
    double capacity_mah = 1.0;       // > 0; a configuration has to say it
    double idle_ma = 100.0;          // processor, sensors and infrared receivers
    double motor_ma = 100.0;         // a motor at full power; in proportion below
    double led_ma = 36.0;            // an LED that is white at full brightness; in proportion below
    double initial_percent = 100.0;  // charge at the start of the run

    friend bool operator==(BatterySpec const&, BatterySpec const&) = default;
};

/// What a write does to a page of flash memory that has been written before.
enum class FlashWrites {
    overwrite,  // it replaces the page
    nor,        // it clears bits and sets none, as on the robot
};

/// The part of an object that runs user code.
struct RobotSpec {
    friend bool operator==(RobotSpec const&, RobotSpec const&) = default;

    RobotModel model;
    IrSpec ir;
    float max_linear_speed_mm_s = 100.0F;   // see Drive
    float max_angular_speed_rad_s = 1.0F;   // see two_wheels()
    float linear_noise_stddev = 0.0F;       // per velocity component and control tick, in units of 100 mm/s
    float angular_noise_stddev = 0.0F;      // rad/s per control tick
    IntRange motor_bias;                    // PWM units, drawn once per robot: left + b, right - b
    IntRange photosensor_bias;              // sensor counts, drawn once per sensor
    float photosensor_noise_stddev = 0.0F;  // sensor counts per reading
    float clock_drift_stddev_us = 0.0F;     // constant drift of a robot's clock, microseconds per tick
    std::optional<FlashWrites> flash{};     // absent: that of the top level, else overwrite
    bool rotate_leds_45_deg = true;         // drawing only
    bool magnetometer_enabled = true;       // else programs find none
    SensorSpec sensors;
    std::optional<BatterySpec> battery{};        // absent: always full
    BrainSpec brain{};                           // what drives it
    CpuTime cpu_time = CpuTime::off;             // whether its code takes time
    std::vector<FunctionCost> function_costs{};  // how much, if it is a program in C
};

/// A soft body: bodies along the outline of the shape, joined into a ring by springs.
struct MembraneSpec {
    int body_count = 100;
    bool segments = false;                // rectangles joined by hinges; else disks
    float radius_mm = 10.0F;              // of a disk
    std::optional<float> thickness_mm{};  // of the segments; absent: radius_mm
    int cross_span = 3;                   // > 1: weaker springs from each body to the one this many places further on
    float stiffness_hz = 30.0F;           // of the springs; their damping ratio is the body's linear damping
    bool in_data_file = false;            // a row for each body, with its subpart_id

    friend bool operator==(MembraneSpec const&, MembraneSpec const&) = default;
};

enum class Colormap { rainbow, qualitative };

/// The parts of the objects of a category; all are optional.
struct ObjectSpec {
    Shape shape;
    std::optional<BodySpec> body;  // tangible: takes part in collisions
    std::optional<MembraneSpec>
        membrane;                    // the body is a soft membrane along the shape's outline instead of the rigid shape
    std::optional<RobotSpec> robot;  // runs user code
    std::optional<LampSpec> lamp;    // gives light
    Colormap colormap = Colormap::rainbow;  // drawing only

    friend bool operator==(ObjectSpec const&, ObjectSpec const&) = default;
};

}  // namespace pogosim
