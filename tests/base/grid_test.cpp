#include "base/grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "base/random.hpp"

namespace pogosim {
namespace {

/// Every point within the radius is visited exactly once, whatever the cells.
void check_against_all_pairs(bool periodic, float cell_mm, float radius_mm, Vec2 size_mm) {
    RandomStream random(1, 1);
    std::vector<Vec2> points;
    for (int i = 0; i < 300; ++i) {
        points.push_back({random.uniform(0, size_mm.x), random.uniform(0, size_mm.y)});
    }
    UniformGrid grid;
    grid.build(points, {{0, 0}, size_mm}, cell_mm, periodic);
    for (Vec2 const centre : points) {
        std::vector<int> visits(points.size());
        grid.for_each_near(centre, radius_mm, [&](std::uint32_t i, Vec2 /*point*/) { ++visits[i]; });
        for (std::size_t i = 0; i < points.size(); ++i) {
            Vec2 d = points[i] - centre;
            if (periodic) {
                d = {std::remainder(d.x, size_mm.x), std::remainder(d.y, size_mm.y)};
            }
            EXPECT_LE(visits[i], 1);
            if (length(d) <= radius_mm) {
                EXPECT_EQ(visits[i], 1) << "cell " << cell_mm << ", radius " << radius_mm;
            }
        }
    }
}

TEST(UniformGrid, VisitsEveryPointWithinTheRadiusOnce) {
    for (bool const periodic : {false, true}) {
        for (float const cell_mm : {1.0F, 60.0F, 133.0F, 900.0F, 5000.0F}) {
            for (float const radius_mm : {1.0F, 133.0F, 700.0F, 4000.0F}) {
                check_against_all_pairs(periodic, cell_mm, radius_mm, {1000, 1000});
            }
        }
    }
}

TEST(UniformGrid, WorksInALongNarrowArena) {
    for (bool const periodic : {false, true}) {
        check_against_all_pairs(periodic, 100.0F, 150.0F, {5000, 60});
    }
}

TEST(UniformGrid, PointsOutsideTheBoundsAreFound) {
    std::vector<Vec2> const points{{-50, 500}, {1200, 500}};
    UniformGrid grid;
    grid.build(points, {{0, 0}, {1000, 1000}}, 100.0F, false);
    int visits = 0;
    grid.for_each_near({-60, 500}, 20.0F, [&](std::uint32_t i, Vec2 /*point*/) { visits += i == 0 ? 1 : 0; });
    grid.for_each_near({1190, 500}, 20.0F, [&](std::uint32_t i, Vec2 /*point*/) { visits += i == 1 ? 1 : 0; });
    EXPECT_EQ(visits, 2);
}

TEST(UniformGrid, PeriodicOneWrapsPointsAndQueriesOutsideTheBounds) {
    std::vector<Vec2> const points{{-50, 500}, {2950, 1500}, {950, -500}, {950, 500}};  // all the same place
    UniformGrid grid;
    grid.build(points, {{0, 0}, {1000, 1000}}, 100.0F, true);
    for (Vec2 const centre : {Vec2{950, 500}, Vec2{-50, 500}, Vec2{-2050, 2500}, Vec2{1950, -1500}}) {
        int visits = 0;
        grid.for_each_near(centre, 20.0F, [&](std::uint32_t /*index*/, Vec2 /*point*/) { ++visits; });
        EXPECT_EQ(visits, 4);
    }
}

}  // namespace
}  // namespace pogosim
