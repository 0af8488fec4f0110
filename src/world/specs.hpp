// What is fixed for a whole run: the parameters of bodies, robots and lamps, one struct per category, as the
// configuration gave them. Defaults stand here and nowhere else.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "geometry/shape.hpp"

namespace pogosim {

/// Rigid-body parameters.
struct BodySpec {
    float linear_damping = 0.0F;   // 1/s
    float angular_damping = 0.0F;  // 1/s
    float density = 10.0F;         // mass per (100 mm)^2, > 0
    float friction = 0.3F;         // Coulomb coefficient; two bodies: geometric mean
    float restitution = 0.5F;      // 0 to 1; two bodies: the larger
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
};

/// Infrared link of one category of robots.
struct IrSpec {
    float range_mm = 80.0F;  // from an emitter to the receiver's border; 0: mute
    ReceptionSpec reception;
    int queue_size = 20;  // messages a robot's FIFO holds; the newest is dropped when it is full
};

struct IntRange {
    int min = 0;
    int max = 0;
};

/// One category of objects that run user code.
struct RobotSpec {
    Shape shape;
    BodySpec body;
    IrSpec ir;
    float max_linear_speed_mm_s = 100.0F;   // both motors at full power
    float max_angular_speed_rad_s = 1.0F;   // one motor full turns at twice this
    float linear_noise_stddev = 0.0F;       // per velocity component and control tick, in units of 100 mm/s
    float angular_noise_stddev = 0.0F;      // rad/s per control tick
    IntRange motor_bias;                    // PWM units, drawn once per robot: left + b, right - b
    IntRange photosensor_bias;              // sensor counts, drawn once per sensor
    float photosensor_noise_stddev = 0.0F;  // sensor counts per reading
    float clock_drift_stddev_us = 0.0F;     // constant drift of a robot's clock, microseconds per tick
    bool rotate_leds_45_deg = true;         // drawing only
};

enum class LightMode { uniform, gradient, plane };

/// A lamp that stands still: `static_light`.
struct LampSpec {
    Shape shape;
    Vec2 centre_mm;
    LightMode mode = LightMode::uniform;
    int value = 10;                    // sensor counts, 0 to 32767
    int edge_value = 0;                // gradient, plane: value at the far side
    float gradient_radius_mm = -1.0F;  // <= 0: largest distance inside the shape
    float plane_angle_rad = 0.0F;      // direction of the plane's normal
    float plane_half_span_mm = 1000.0F;
    float photo_start_at_s = -1.0F;  // >= 0: dark before, flash of photo_start_value, then normal
    float photo_start_duration_s = 1.0F;
    int photo_start_value = 32767;
};

}  // namespace pogosim
