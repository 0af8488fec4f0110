// The lighthouse with one beam: rotating_ray_of_light. A cycle is a flash, then a turn of the beam from angle 0.
//
//     |flash|---- beam from 0 to 2 pi ----|flash|---- ...
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "config/lamp_keys.hpp"
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/shape_keys.hpp"
#include "lamps/ray_spec.hpp"
#include "light/bearing_order.hpp"
#include "light/lamp.hpp"
#include "light/lit_area.hpp"

namespace pogosim {

/// A lighthouse in the centre, whose beam begins at angle 0: `rotating_ray_of_light`.
struct RotatingRaySpec : RaySpec {
    double white_frame_duration_s = 0.03;  // flash at the start and each time the beam is back at angle 0; it waits
    double photo_start_at_s = -1.0;        // >= 0: dark until the end of the photo start, then the first flash
    double photo_start_duration_s = 1.0;

    friend bool operator==(RotatingRaySpec const&, RotatingRaySpec const&) = default;
};

namespace rotating_ray {

enum Phase { dark, white, beam };

inline double activation_s(RotatingRaySpec const& spec) {
    return spec.photo_start_at_s < 0.0 ? 0.0 : spec.photo_start_at_s + spec.photo_start_duration_s;
}

/// Infinite when the beam does not turn.
inline double cycle_s(RotatingRaySpec const& spec) {
    return spec.white_frame_duration_s + 2.0 * std::numbers::pi / std::abs(spec.angular_speed_rad_s);
}

class RotatingRayLamp : public Lamp {
public:
    RotatingRayLamp(RotatingRaySpec const& spec, Arena const& arena, LightMap const& map)
        : spec_(spec),
          apex_mm_(middle_of_light(spec.shape, spec.centre_mm, arena)),
          cycle_s_(cycle_s(spec)),
          cells_(lit_cells(spec.shape, spec.centre_mm, arena, map), apex_mm_) {}

    Layer layer() const override { return Layer::overwriting; }

    LampState state_at(double time_s) const override {
        double const on_for_s = time_s - activation_s(spec_) + kTimeToleranceS;
        if (on_for_s < 0.0) {
            return {.phase = dark};
        }
        double const turning_s = std::fmod(on_for_s, cycle_s_) - spec_.white_frame_duration_s;
        if (turning_s < 0.0) {
            return {.phase = white};
        }
        return {.phase = beam, .angle_rad = spec_.angular_speed_rad_s * std::max(turning_s - kTimeToleranceS, 0.0)};
    }

    void paint(LampState const& state, LightMap& map, std::vector<std::uint32_t>& painted) const override {
        if (state.phase == white) {
            overwrite(cells_.all(), spec_.white_frame_value, map, painted);
        } else if (state.phase == beam) {
            for (CellRun const run : cells_.beam(state.angle_rad, spec_.half_width_rad)) {
                overwrite(run, spec_.value, map, painted);
            }
        }
    }

    Vec2 source_mm(LampState const&) const override { return apex_mm_; }

    void mark(LampState const& state, std::vector<LampMark>& marks) const override {
        bool const is_on = state.phase == beam;
        marks.push_back({.centre_mm = apex_mm_,
                         .shape = spec_.shape,
                         .shape_mm = apex_mm_,
                         .has_beam = true,
                         .beam_rad = is_on ? wrap_angle(static_cast<float>(state.angle_rad)) : 0.0F,
                         .beam_is_on = is_on});
    }

private:
    RotatingRaySpec spec_;
    Vec2 apex_mm_;
    double cycle_s_;
    BearingOrder cells_;  // as seen from where it stands
};

inline std::span<Key<RotatingRaySpec> const> rotating_ray_keys() {
    using S = RotatingRaySpec;
    using K = Key<S>;
    static std::array const keys{
        K{"value", &S::value, kLightLevel, "sensor counts", "Level in the beam, replacing that of other lamps."},
        K{"ray_half_width", &S::half_width_rad, kHalfWidth, "rad",
          "Half-width of the beam, to either side of its direction."},
        K{"angular_speed", &S::angular_speed_rad_s, kAngularSpeed, "rad/s",
          "Positive: clockwise on the screen. 0: the beam stays at angle 0, along +x."},
        K{"white_frame_duration", &S::white_frame_duration_s, kSeconds, "s",
          "Duration of the flash over the whole shape, at the start and whenever the beam returns to angle 0, where it "
          "waits meanwhile."},
        K{"white_frame_value", &S::white_frame_value, kLightLevel, "sensor counts", "Level of the flash."},
        K{"photo_start_at", &S::photo_start_at_s, kStartTime, "s",
          "Dark until this time and for `photo_start_duration` after it. Negative: no photo start."},
        K{"photo_start_duration", &S::photo_start_duration_s, kSeconds, "s", "See photo_start_at."}.only_if(
            [](S const& spec) { return spec.photo_start_at_s >= 0.0; }),
    };
    return keys;
}

inline void read_rotating_ray_of_light(MapReader& reader, ObjectConfig& object) {
    RotatingRaySpec spec;
    read_lighthouse_place(reader, spec.shape, spec.centre_mm);
    reader.read(rotating_ray_keys(), spec);
    make_lamp_object(reader, object, spec, /*has_place=*/true);
}

}  // namespace rotating_ray

inline std::shared_ptr<Lamp const> make_lamp(RotatingRaySpec const& spec, Arena const& arena, LightMap const& map) {
    return std::make_shared<rotating_ray::RotatingRayLamp>(spec, arena, map);
}

}  // namespace pogosim
