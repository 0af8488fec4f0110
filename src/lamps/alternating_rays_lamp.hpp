// Two lighthouses in turn: alternating_rays_of_light. What one cycle looks like, with the corners the beams come from:
//
//     |long white|-- ray 1, bottom left --|short white|-- ray 2, bottom right --|long white| ...
//
// Each ray turns through a right angle, whose middle is the direction from its corner to the centre of the box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "base/exact_math.hpp"
#include "config/lamp_keys.hpp"
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/shape_keys.hpp"
#include "lamps/ray_spec.hpp"
#include "light/bearing_order.hpp"
#include "light/lamp.hpp"
#include "light/lit_area.hpp"

namespace pogosim {

/// Two lighthouses in turn, each through a right angle, a flash before each: `alternating_rays_of_light`. They stand at
/// the corners (xmin, ymax) and (xmax, ymax) of the shape's bounding box.
struct AlternatingRaysSpec : RaySpec {
    double long_white_frame_duration_s = 1.0;    // before the first beam
    double short_white_frame_duration_s = 0.03;  // before the second beam

    friend bool operator==(AlternatingRaysSpec const&, AlternatingRaysSpec const&) = default;
};

namespace alternating_rays {

enum Phase { long_white, ray_1, short_white, ray_2, phase_count };

inline constexpr double kSweepRad = std::numbers::pi / 2.0;

struct Lighthouse {
    Vec2 corner_mm;              // where it stands
    BearingOrder cells;          // as seen from there
    double to_centre_rad = 0.0;  // direction of the box's centre

    /// Direction of the beam when it has turned so far since the start of its sweep.
    double beam_rad(AlternatingRaysSpec const& spec, double turned_rad) const {
        return to_centre_rad - std::copysign(0.5 * kSweepRad, spec.angular_speed_rad_s) + turned_rad;
    }

    /// Cells in the beam.
    std::array<CellRun, 2> beam(AlternatingRaysSpec const& spec, double turned_rad) const {
        return cells.beam(beam_rad(spec, turned_rad), spec.half_width_rad);
    }

    LampMark mark(AlternatingRaysSpec const& spec, LampState const& state, bool is_on) const {
        return {.centre_mm = corner_mm,
                .shape = spec.shape,
                .shape_mm = spec.centre_mm,
                .has_beam = true,
                .beam_rad = is_on ? wrap_angle(static_cast<float>(beam_rad(spec, state.angle_rad))) : 0.0F,
                .beam_is_on = is_on};
    }
};

inline Lighthouse lighthouse_at(Vec2 corner_mm, Vec2 centre_mm, std::vector<LitCell> const& cells) {
    Vec2 const to_centre = centre_mm - corner_mm;
    return {.corner_mm = corner_mm,
            .cells = BearingOrder(cells, corner_mm),
            .to_centre_rad = exact::atan2(static_cast<double>(to_centre.y), static_cast<double>(to_centre.x))};
}

class AlternatingRaysLamp : public Lamp {
public:
    AlternatingRaysLamp(AlternatingRaysSpec const& spec, Arena const& arena, LightMap const& map)
        : AlternatingRaysLamp(spec, lit_cells(spec.shape, spec.centre_mm, arena, map),
                              lit_box(spec.shape, spec.centre_mm, arena)) {}

    Layer layer() const override { return Layer::overwriting; }

    LampState state_at(double time_s) const override {
        double since_s = std::fmod(time_s + kTimeToleranceS, cycle_s_);
        int phase = long_white;
        while (phase < ray_2 && since_s >= duration_s_[phase]) {
            since_s -= duration_s_[phase];
            ++phase;
        }
        bool const turns = phase == ray_1 || phase == ray_2;
        return {.phase = phase,
                .angle_rad = turns ? spec_.angular_speed_rad_s * std::max(since_s - kTimeToleranceS, 0.0) : 0.0};
    }

    void paint(LampState const& state, LightMap& map, std::vector<std::uint32_t>& painted) const override {
        if (state.phase == long_white || state.phase == short_white) {
            overwrite(first_.cells.all(), spec_.white_frame_value, map, painted);
            return;
        }
        Lighthouse const& lit = state.phase == ray_1 ? first_ : second_;
        for (CellRun const run : lit.beam(spec_, state.angle_rad)) {
            overwrite(run, spec_.value, map, painted);
        }
    }

    /// A flash comes from the lighthouse whose beam follows.
    Vec2 source_mm(LampState const& state) const override {
        return state.phase == long_white || state.phase == ray_1 ? first_.corner_mm : second_.corner_mm;
    }

    void mark(LampState const& state, std::vector<LampMark>& marks) const override {
        marks.push_back(first_.mark(spec_, state, state.phase == ray_1));
        marks.push_back(second_.mark(spec_, state, state.phase == ray_2));
    }

private:
    AlternatingRaysLamp(AlternatingRaysSpec const& spec, std::vector<LitCell> const& cells, Box const& box)
        : spec_(spec),
          first_(lighthouse_at({box.min.x, box.max.y}, box.centre(), cells)),
          second_(lighthouse_at(box.max, box.centre(), cells)) {
        double const sweep_s = kSweepRad / std::abs(spec.angular_speed_rad_s);  // infinite when it does not turn
        duration_s_ = {spec.long_white_frame_duration_s, sweep_s, spec.short_white_frame_duration_s, sweep_s};
        cycle_s_ = spec.long_white_frame_duration_s + spec.short_white_frame_duration_s + 2.0 * sweep_s;
    }

    AlternatingRaysSpec spec_;
    std::array<double, phase_count> duration_s_{};
    double cycle_s_ = 0.0;
    Lighthouse first_;
    Lighthouse second_;
};

inline std::span<Key<AlternatingRaysSpec> const> alternating_rays_keys() {
    using S = AlternatingRaysSpec;
    using K = Key<S>;
    static std::array const keys{
        K{"value", &S::value, kLightLevel, "sensor counts", "Level in the beams, replacing that of other lamps."},
        K{"ray_half_width", &S::half_width_rad, kHalfWidth, "rad",
          "Half-width of a beam, to either side of its direction."},
        K{"angular_speed", &S::angular_speed_rad_s, kAngularSpeed, "rad/s",
          "Angular speed of both beams; positive: clockwise on the screen. 0: the first beam never moves."},
        K{"long_white_frame_duration", &S::long_white_frame_duration_s, kSeconds, "s",
          "Duration of the flash over the whole shape before the first beam."},
        K{"short_white_frame_duration", &S::short_white_frame_duration_s, kSeconds, "s",
          "Duration of the flash before the second beam."},
        K{"white_frame_value", &S::white_frame_value, kLightLevel, "sensor counts", "Level of both flashes."},
    };
    return keys;
}

inline void read_alternating_rays_of_light(MapReader& reader, ObjectConfig& object) {
    AlternatingRaysSpec spec;
    read_lighthouse_place(reader, spec.shape, spec.centre_mm);
    reader.read(alternating_rays_keys(), spec);
    make_lamp_object(reader, object, spec, /*has_place=*/true);
}

}  // namespace alternating_rays

inline std::shared_ptr<Lamp const> make_lamp(AlternatingRaysSpec const& spec, Arena const& arena, LightMap const& map) {
    return std::make_shared<alternating_rays::AlternatingRaysLamp>(spec, arena, map);
}

}  // namespace pogosim
