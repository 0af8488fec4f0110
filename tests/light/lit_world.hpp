// Worlds of 1000 mm x 1000 mm in 100 x 100 cells, so that cell centres are at 5, 15, ... 995 mm.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "lamps/alternating_rays_lamp.hpp"
#include "lamps/rotating_ray_lamp.hpp"
#include "lamps/spot_lamp.hpp"
#include "light/lighting.hpp"
#include "support/small_world.hpp"

namespace pogosim::testing {

inline World dark_world() {
    World world = square_world();
    world.light = make_light_map(world.arena, world.periodic, 100, 100);
    return world;
}

/// As these lamps light it at that time, without a look at what was before.
inline World lit_world(std::vector<LampSpec> const& lamps, double time_s = 0.0) {
    World world = dark_world();
    world.step = std::lround(time_s / world.time_step_s);
    Lighting(lamps, world).update(world);
    return world;
}

/// Calls visit(level, centre of the cell) for every cell.
template <class Visit>
void for_each_cell(World const& world, Visit const& visit) {
    for (int row = 0; row < 100; ++row) {
        for (int column = 0; column < 100; ++column) {
            Vec2 const centre{10.0F * static_cast<float>(column) + 5.0F, 10.0F * static_cast<float>(row) + 5.0F};
            visit(world.light.level[static_cast<std::size_t>(100 * row + column)], centre);
        }
    }
}

inline int count_cells(World const& world, int level) {
    int count = 0;
    for_each_cell(world, [&](int at, Vec2) { count += at == level ? 1 : 0; });
    return count;
}

inline SpotSpec global_lamp(int value) {
    SpotSpec lamp;
    lamp.shape.kind = ShapeKind::global;
    lamp.value = value;
    return lamp;
}

/// 200 mm around the cell centre (505, 505).
inline SpotSpec disk_lamp(int value) {
    SpotSpec lamp;
    lamp.shape.radius_mm = 200.0F;
    lamp.centre_mm = {505, 505};
    lamp.value = value;
    return lamp;
}

/// Angle between two directions, 0 to pi.
inline double angle_between(double a_rad, double b_rad) {
    return std::abs(std::remainder(a_rad - b_rad, 2.0 * std::numbers::pi));
}

inline double bearing(Vec2 from, Vec2 to) {
    return std::atan2(static_cast<double>(to.y) - from.y, static_cast<double>(to.x) - from.x);
}

/// What a beam from `apex` lights: cells in it have `lit`, the others `unlit`. Cells at its very edge may have either.
inline void expect_beam(World const& world, Vec2 apex, double angle_rad, double half_width_rad, int lit, int unlit) {
    constexpr double kEdge = 1e-5;
    int wrong = 0;
    for_each_cell(world, [&](int level, Vec2 centre) {
        double const off = angle_between(bearing(apex, centre), angle_rad);
        bool const at_edge = std::abs(off - half_width_rad) < kEdge;
        wrong += !at_edge && level != (off < half_width_rad ? lit : unlit) ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0) << "beam at " << angle_rad;
}

}  // namespace pogosim::testing
