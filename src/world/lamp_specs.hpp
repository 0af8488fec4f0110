// The parameters of lamps. A kind of lamp is a struct here, a file in src/light, and a function in
// src/config/lamp_types.cpp. Each struct says what all of them have: shape, centre_mm, where it stands at first,
// whether its light adds to that of others, its brightest level, and how its levels are scaled.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>

#include "base/vec2.hpp"
#include "geometry/shape.hpp"

namespace pogosim {

/// A level times an intensity, within 15 bits.
inline int scaled_level(int level, float intensity) {
    constexpr auto brightest = static_cast<float>(std::numeric_limits<std::int16_t>::max());
    return static_cast<int>(std::lround(std::clamp(static_cast<float>(level) * intensity, 0.0F, brightest)));
}

enum class LightMode { uniform, gradient, plane };

/// A circle along which a lamp moves.
struct Orbit {
    float radius_mm = 0.0F;            // 0: the lamp stands still in the centre
    double angular_speed_rad_s = 0.0;  // > 0: clockwise on the screen
    double phase_rad = 0.0;            // where on the circle at time 0, from +x

    friend bool operator==(Orbit const&, Orbit const&) = default;
};

/// A spot of light, which adds to that of other lamps: `static_light`, `orbiting_static_light`.
struct SpotSpec {
    Shape shape;
    Vec2 centre_mm;  // where the lamp stands, or the centre of its orbit
    Orbit orbit;
    LightMode mode = LightMode::uniform;
    int value = 10;                    // sensor counts, 0 to 32767
    int edge_value = 0;                // gradient, plane: value at the far side
    float gradient_radius_mm = -1.0F;  // <= 0: largest distance inside the shape
    float plane_angle_rad = 0.0F;      // direction of the plane's normal
    float plane_half_span_mm = 1000.0F;
    float photo_start_at_s = -1.0F;  // >= 0: dark before, flash of photo_start_value, then normal
    float photo_start_duration_s = 1.0F;
    int photo_start_value = 32767;

    static constexpr bool kAddsUp = true;
    Vec2 start_mm() const { return centre_mm + orbit.radius_mm * direction(static_cast<float>(orbit.phase_rad)); }
    int brightest() const {
        return std::max(
            {value, mode == LightMode::uniform ? 0 : edge_value, photo_start_at_s < 0.0F ? 0 : photo_start_value});
    }
    void scale_levels(float intensity) {
        for (int* const level : {&value, &edge_value, &photo_start_value}) {
            *level = scaled_level(*level, intensity);
        }
    }

    friend bool operator==(SpotSpec const&, SpotSpec const&) = default;
};

/// Beams that rotate, and flashes of white light. Their light replaces all other light.
struct RaySpec {
    Shape shape;                       // the area that they can light
    Vec2 centre_mm;                    // of the shape; global and arena: from the centre of the arena's bounding box
    int value = 10;                    // of the beam, sensor counts
    double half_width_rad = 0.1;       // above 0 to pi
    double angular_speed_rad_s = 3.0;  // > 0: clockwise on the screen; 0: the beam stays where it is at first
    int white_frame_value = 32767;

    static constexpr bool kAddsUp = false;
    Vec2 start_mm() const { return centre_mm; }
    int brightest() const { return std::max(value, white_frame_value); }
    void scale_levels(float intensity) {
        value = scaled_level(value, intensity);
        white_frame_value = scaled_level(white_frame_value, intensity);
    }

    friend bool operator==(RaySpec const&, RaySpec const&) = default;
};

/// A lighthouse in the centre, whose beam begins at angle 0: `rotating_ray_of_light`.
struct RotatingRaySpec : RaySpec {
    double white_frame_duration_s = 0.03;  // flash at the start and each time the beam is back at angle 0; it waits
    double photo_start_at_s = -1.0;        // >= 0: dark until the end of the photo start, then the first flash
    double photo_start_duration_s = 1.0;

    friend bool operator==(RotatingRaySpec const&, RotatingRaySpec const&) = default;
};

/// Two lighthouses in turn, each through a right angle, a flash before each: `alternating_rays_of_light`. They stand at
/// the corners (xmin, ymax) and (xmax, ymax) of the shape's bounding box.
struct AlternatingRaysSpec : RaySpec {
    double long_white_frame_duration_s = 1.0;    // before the first beam
    double short_white_frame_duration_s = 0.03;  // before the second beam

    friend bool operator==(AlternatingRaysSpec const&, AlternatingRaysSpec const&) = default;
};

using LampSpec = std::variant<SpotSpec, RotatingRaySpec, AlternatingRaysSpec>;

}  // namespace pogosim
