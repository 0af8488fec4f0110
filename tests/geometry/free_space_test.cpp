#include "geometry/formations/free_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "base/random.hpp"

namespace pogosim {
namespace {

/// A star whose corners have random distances from its centre.
Polygon star(int corners, RandomStream& random) {
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        float const angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(corners);
        polygon.push_back(random.uniform(50.0F, 500.0F) * Vec2{std::cos(angle), std::sin(angle)});
    }
    return polygon;
}

std::vector<Arena> arenas() {
    std::vector<Arena> all;
    for (auto const& entry : std::filesystem::directory_iterator(std::string(POGOSIM_SOURCE_DIR) + "/arenas")) {
        if (!is_empty_arena_file(entry.path())) {
            all.push_back(scale_arena(read_arena_file(entry.path()), {}));
        }
    }
    RandomStream random(3, 0);
    for (int corners = 3; corners < 400; corners *= 2) {
        all.push_back(make_arena({star(corners, random)}));
    }
    all.push_back(make_arena({{{0.0F, 0.0F}, {1e6F, 1.0F}, {1e6F, 2.0F}, {0.0F, 1.0F}}}));  // long and thin
    return all;
}

}  // namespace

TEST(FreeSpace, HoldsPointsInsideOfTheArena) {
    RandomStream random(4, 0);
    for (Arena const& arena : arenas()) {
        FreeSpace const space(arena, {});
        Vec2 const size = arena.bounds.size();
        for (int i = 0; i < 20000; ++i) {
            Vec2 const point =
                arena.bounds.min + Vec2{random.uniform(-0.1F, 1.1F) * size.x, random.uniform(-0.1F, 1.1F) * size.y};
            ASSERT_EQ(space.holds(point, 0.0F), arena.contains(point)) << point.x << ' ' << point.y;
        }
        for (Polygon const& polygon : arena.polygons) {  // and at its corners
            for (Vec2 const corner : polygon) {
                ASSERT_EQ(space.holds(corner, 0.0F), arena.contains(corner)) << corner.x << ' ' << corner.y;
            }
        }
    }
}

TEST(FreeSpace, KeepsTheClearanceFromWalls) {
    RandomStream random(5, 0);
    for (Arena const& arena : arenas()) {
        FreeSpace const space(arena, {});
        float const clearance = 0.05F * std::min(arena.bounds.size().x, arena.bounds.size().y);
        for (int i = 0; i < 5000; ++i) {
            Vec2 const point = space.random_point(random);
            float const distance = arena.distance_to_walls(point);
            if (std::fabs(distance - clearance) > 1.0e-4F * clearance) {
                ASSERT_EQ(space.holds(point, clearance), arena.contains(point) && distance > clearance);
            }
        }
    }
}

}  // namespace pogosim
