// What all lamps with beams have.
#pragma once

#include <algorithm>

#include "world/lamp_spec.hpp"

namespace pogosim {

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

}  // namespace pogosim
