// Spots of light: static_light and orbiting_static_light.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "light/lamp.hpp"
#include "light/lit_area.hpp"

namespace pogosim {

namespace {

/// A lamp with a photo start is dark, then flashes, then shines as configured.
enum Phase { dark, flash, normal };

Phase phase_at(SpotSpec const& spec, double time_s) {
    auto const start_s = static_cast<double>(spec.photo_start_at_s);
    if (start_s < 0.0) {
        return normal;
    }
    if (time_s < start_s - kTimeToleranceS) {
        return dark;
    }
    return time_s < start_s + static_cast<double>(spec.photo_start_duration_s) - kTimeToleranceS ? flash : normal;
}

/// Also false for orbiting lamps that always look the same.
bool is_seen_moving(SpotSpec const& spec) {
    bool const is_same_everywhere = is_everywhere(spec.shape) && spec.mode == LightMode::uniform;
    return spec.orbit.radius_mm > 0.0F && spec.orbit.angular_speed_rad_s != 0.0 && !is_same_everywhere;
}

/// Largest distance from the lamp's centre to a point it can light.
float farthest_mm(Shape const& shape, Vec2 centre_mm, Box const& bounds, bool periodic) {
    if (!is_everywhere(shape)) {
        return bounding_radius(shape);
    }
    if (periodic) {
        return 0.5F * length(bounds.size());
    }
    std::array const corners{bounds.min, bounds.max, Vec2{bounds.min.x, bounds.max.y},
                             Vec2{bounds.max.x, bounds.min.y}};
    float farthest = 0.0F;
    for (Vec2 const corner : corners) {
        farthest = std::max(farthest, length(corner - centre_mm));
    }
    return farthest;
}

/// Levels from one to another as the share goes from 0 to 1, clamped outside.
class Blend {
public:
    Blend(int from, int to) : start_(static_cast<float>(from) + 0.5F), rise_(static_cast<float>(to - from)) {}

    int at(float share) const { return static_cast<int>(start_ + rise_ * std::clamp(share, 0.0F, 1.0F)); }

private:
    float start_;  // half a count more, so that cutting the fraction rounds: levels are not negative
    float rise_;
};

class SpotLamp : public Lamp {
public:
    SpotLamp(SpotSpec const& spec, Arena const& arena, LightMap const& map) : spec_(spec), bounds_(arena.bounds) {
        if (spec.shape.kind == ShapeKind::arena) {
            for (LitCell const& lit : lit_cells(spec.shape, spec.centre_mm, arena, map)) {
                arena_cells_.push_back(lit.cell);
            }
        }
    }

    Layer layer() const override { return is_seen_moving(spec_) ? Layer::moving : Layer::still; }

    LampState state_at(double time_s) const override {
        double const turned = is_seen_moving(spec_) ? spec_.orbit.angular_speed_rad_s * time_s : 0.0;
        return {.phase = phase_at(spec_, time_s),
                .angle_rad = std::remainder(spec_.orbit.phase_rad + turned, 2.0 * std::numbers::pi)};
    }

    void paint(LampState const& state, LightMap& map, std::vector<std::uint32_t>& painted) const override;

    void mark(LampState const& state, std::vector<LampMark>& marks) const override {
        if (!is_everywhere(spec_.shape) || spec_.mode == LightMode::gradient) {
            marks.push_back({.centre_mm = centre_mm(state), .shape = spec_.shape, .shape_mm = centre_mm(state)});
        }
    }

private:
    Vec2 centre_mm(LampState const& state) const {
        return spec_.centre_mm + spec_.orbit.radius_mm * direction(static_cast<float>(state.angle_rad));
    }

    template <class LevelAt>
    void add(Vec2 centre_mm, LevelAt const& level_at, LightMap& map, std::vector<std::uint32_t>& painted) const;

    SpotSpec spec_;
    Box bounds_;                              // of the arena
    std::vector<std::uint32_t> arena_cells_;  // lit ones, of lamps in the shape of the arena
};

void SpotLamp::paint(LampState const& state, LightMap& map, std::vector<std::uint32_t>& painted) const {
    if (state.phase == dark) {
        return;
    }
    Vec2 const centre = centre_mm(state);
    Blend const blend(spec_.value, spec_.edge_value);
    if (state.phase == flash) {
        add(
            centre, [&](Vec2) { return spec_.photo_start_value; }, map, painted);
    } else if (spec_.mode == LightMode::gradient) {
        float const radius = spec_.gradient_radius_mm > 0.0F ? spec_.gradient_radius_mm
                                                             : farthest_mm(spec_.shape, centre, bounds_, map.periodic);
        float const share_per_mm = 1.0F / radius;
        add(
            centre, [&](Vec2 offset) { return blend.at(length(offset) * share_per_mm); }, map, painted);
    } else if (spec_.mode == LightMode::plane) {
        Vec2 const share_per_mm = (0.5F / spec_.plane_half_span_mm) * direction(spec_.plane_angle_rad);
        add(
            centre, [&](Vec2 offset) { return blend.at(0.5F + dot(offset, share_per_mm)); }, map, painted);
    } else {
        add(
            centre, [&](Vec2) { return spec_.value; }, map, painted);
    }
}

template <class LevelAt>
void SpotLamp::add(Vec2 centre_mm, LevelAt const& level_at, LightMap& map, std::vector<std::uint32_t>& painted) const {
    constexpr int brightest = std::numeric_limits<std::int16_t>::max();
    bool const moves = layer() == Layer::moving;
    auto const add_to = [&](std::uint32_t cell, Vec2 point_mm) {
        int const sum = map.level[cell] + level_at(point_mm - centre_mm);
        map.level[cell] = static_cast<std::int16_t>(std::min(sum, brightest));
        if (moves) {
            painted.push_back(cell);
        }
    };
    if (spec_.shape.kind != ShapeKind::arena) {
        for_each_cell_in(spec_.shape, centre_mm, map, add_to);
        return;
    }
    for (std::uint32_t const cell : arena_cells_) {
        add_to(cell, nearest_image(map, centre_mm, cell_centre_mm(map, cell)));
    }
}

}  // namespace

std::unique_ptr<Lamp> make_lamp(SpotSpec const& spec, Arena const& arena, LightMap const& map) {
    return std::make_unique<SpotLamp>(spec, arena, map);
}

}  // namespace pogosim
