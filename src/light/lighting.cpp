#include "light/lighting.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pogosim {

namespace {

constexpr int kBrightest = 32767;

/// A lamp with a photo start is dark, then flashes, then shines as configured.
enum Phase { dark, flash, normal };

Phase phase_of(LampSpec const& lamp, double time_s) {
    if (lamp.photo_start_at_s < 0.0F) {
        return normal;
    }
    // Steps are counted, so a time that should be equal may differ in the last bits.
    constexpr double tolerance_s = 1e-6;
    if (time_s < static_cast<double>(lamp.photo_start_at_s) - tolerance_s) {
        return dark;
    }
    double const end_s = static_cast<double>(lamp.photo_start_at_s) + static_cast<double>(lamp.photo_start_duration_s);
    return time_s < end_s - tolerance_s ? flash : normal;
}

/// Linear from `from` at 0 to `to` at 1, clamped outside.
int blend(int from, int to, float share) {
    return static_cast<int>(
        std::lround(std::lerp(static_cast<float>(from), static_cast<float>(to), std::clamp(share, 0.0F, 1.0F))));
}

/// Largest distance from the lamp's centre to a point it can light.
float farthest_mm(LampSpec const& lamp, Arena const& arena) {
    bool const whole_map = lamp.shape.kind == ShapeKind::global || lamp.shape.kind == ShapeKind::arena;
    if (!whole_map) {
        return bounding_radius(lamp.shape);
    }
    Box const& b = arena.bounds;
    std::array const corners{b.min, b.max, Vec2{b.min.x, b.max.y}, Vec2{b.max.x, b.min.y}};
    float farthest = 0.0F;
    for (Vec2 const corner : corners) {
        farthest = std::max(farthest, length(corner - lamp.centre_mm));
    }
    return farthest;
}

bool shines_on(LampSpec const& lamp, Arena const& arena, Vec2 point_mm) {
    if (lamp.shape.kind == ShapeKind::arena) {
        return std::any_of(arena.polygons.begin(), arena.polygons.end(),
                           [&](Polygon const& polygon) { return contains(polygon, point_mm); });
    }
    return contains(lamp.shape, point_mm - lamp.centre_mm);
}

int level_at(LampSpec const& lamp, Arena const& arena, Vec2 point_mm) {
    Vec2 const offset = point_mm - lamp.centre_mm;
    switch (lamp.mode) {
        case LightMode::gradient: {
            float const radius = lamp.gradient_radius_mm > 0.0F ? lamp.gradient_radius_mm : farthest_mm(lamp, arena);
            return blend(lamp.value, lamp.edge_value, length(offset) / radius);
        }
        case LightMode::plane: {
            float const along = dot(offset, direction(lamp.plane_angle_rad));
            return blend(lamp.value, lamp.edge_value, 0.5F + 0.5F * along / lamp.plane_half_span_mm);
        }
        case LightMode::uniform:
            break;
    }
    return lamp.value;
}

}  // namespace

int lamp_level(LampSpec const& lamp, Arena const& arena, Vec2 point_mm, double time_s) {
    Phase const phase = phase_of(lamp, time_s);
    if (phase == dark || !shines_on(lamp, arena, point_mm)) {
        return 0;
    }
    return phase == flash ? lamp.photo_start_value : level_at(lamp, arena, point_mm);
}

LightMap make_light_map(Arena const& arena, int columns, int rows) {
    Vec2 const size = arena.bounds.size();
    LightMap map{.columns = columns,
                 .rows = rows,
                 .origin_mm = arena.bounds.min,
                 .cell_mm = {size.x / static_cast<float>(columns), size.y / static_cast<float>(rows)},
                 .level = {}};
    map.level.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
    return map;
}

void Lighting::update(World& world) {
    double const time_s = world.time_s();
    bool changed = shown_phases_.size() != lamps_.size();
    shown_phases_.resize(lamps_.size(), -1);
    for (std::size_t i = 0; i < lamps_.size(); ++i) {
        int const phase = phase_of(lamps_[i], time_s);
        changed = changed || phase != shown_phases_[i];
        shown_phases_[i] = phase;
    }
    if (!changed) {
        return;
    }
    LightMap& map = world.light;
    for (int row = 0; row < map.rows; ++row) {
        for (int column = 0; column < map.columns; ++column) {
            Vec2 const centre = map.origin_mm + Vec2{(static_cast<float>(column) + 0.5F) * map.cell_mm.x,
                                                     (static_cast<float>(row) + 0.5F) * map.cell_mm.y};
            int sum = 0;
            for (LampSpec const& lamp : lamps_) {
                sum += lamp_level(lamp, world.arena, centre, time_s);
            }
            map.level[static_cast<std::size_t>(row * map.columns + column)] =
                static_cast<std::int16_t>(std::min(sum, kBrightest));
        }
    }
}

}  // namespace pogosim
