// The lighthouse with one beam: rotating_ray_of_light. A cycle is a flash, then a turn of the beam from angle 0.
//
//     |flash|---- beam from 0 to 2 pi ----|flash|---- ...
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "light/bearing_order.hpp"
#include "light/lamp.hpp"
#include "light/lit_area.hpp"

namespace pogosim {

namespace {

enum Phase { dark, white, beam };

double activation_s(RotatingRaySpec const& spec) {
    return spec.photo_start_at_s < 0.0 ? 0.0 : spec.photo_start_at_s + spec.photo_start_duration_s;
}

/// Infinite when the beam does not turn.
double cycle_s(RotatingRaySpec const& spec) {
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

}  // namespace

std::unique_ptr<Lamp> make_lamp(RotatingRaySpec const& spec, Arena const& arena, LightMap const& map) {
    return std::make_unique<RotatingRayLamp>(spec, arena, map);
}

}  // namespace pogosim
