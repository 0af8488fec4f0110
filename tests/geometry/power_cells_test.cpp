// The sums over the cells of a power diagram are those of a search through all sites for each point.
#include "geometry/formations/power_cells.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <vector>

#include "base/random.hpp"

namespace pogosim {
namespace {

std::vector<Vec2> points_in(Box const& box, std::size_t count, RandomStream& random) {
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back({box.min.x + box.size().x * random.uniform(), box.min.y + box.size().y * random.uniform()});
    }
    return points;
}

std::vector<PointSum> sums_by_hand(std::vector<Vec2> const& points, std::vector<Vec2> const& sites,
                                   std::vector<float> const& weights) {
    std::vector<PointSum> sums(sites.size());
    for (Vec2 const point : points) {
        std::size_t nearest = 0;
        float least = std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < sites.size(); ++i) {
            if (float const power = squared_length(sites[i] - point) - weights[i]; power < least) {
                least = power;
                nearest = i;
            }
        }
        sums[nearest].add({.x_mm = point.x, .y_mm = point.y, .count = 1});
    }
    return sums;
}

void expect_same(Box const& box, std::vector<Vec2> const& points, std::vector<Vec2> const& sites,
                 std::vector<float> const& weights) {
    auto const found = PowerCells(box, points).sums(sites, weights);
    auto const expected = sums_by_hand(points, sites, weights);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].count, expected[i].count) << "site " << i;
        EXPECT_NEAR(found[i].x_mm, expected[i].x_mm, 1.0e-6) << "site " << i;
        EXPECT_NEAR(found[i].y_mm, expected[i].y_mm, 1.0e-6) << "site " << i;
    }
}

TEST(PowerCells, SumsAreThoseOfASearchThroughAllSites) {
    RandomStream random(1, 0);
    for (Box const& box : {Box{{0, 0}, {1000, 1000}}, Box{{-300, 5000}, {2500, 5040}}, Box{{10, 10}, {10.5F, 900}}}) {
        for (std::size_t const count : {std::size_t{1}, std::size_t{2}, std::size_t{20}, std::size_t{300}}) {
            std::vector<Vec2> const sites = points_in(box, count, random);
            std::vector<float> equal(count, 0.0F);
            std::vector<float> different;
            for (std::size_t i = 0; i < count; ++i) {
                float const radius_mm = 5.0F + 100.0F * random.uniform();
                different.push_back(radius_mm * radius_mm);
            }
            for (std::size_t const points : {std::size_t{1}, std::size_t{49}, std::size_t{5000}}) {
                expect_same(box, points_in(box, points, random), sites, equal);
                expect_same(box, points_in(box, points, random), sites, different);
            }
        }
    }
}

TEST(PowerCells, TheFirstOfEqualSitesHasThePoints) {
    RandomStream random(2, 0);
    Box const box{{0, 0}, {100, 100}};
    expect_same(box, points_in(box, 1000, random), {{50, 50}, {50, 50}, {20, 20}, {20, 20}}, {1, 1, 0, 0});
    // All points are as far from one as from the other.
    std::vector<Vec2> const between(500, Vec2{50, 50});
    expect_same(box, between, {{60, 50}, {40, 50}, {50, 60}}, {0, 0, 0});
}

TEST(PowerCells, ABoxWithoutWidthHasItsPointsInOneColumn) {
    expect_same({{5, 0}, {5, 100}}, std::vector<Vec2>(200, Vec2{5, 30}), {{5, 20}, {5, 90}}, {0, 0});
    EXPECT_EQ(PowerCells({{0, 0}, {1, 1}}, {}).sums(std::vector<Vec2>{{0, 0}}, std::vector<float>{0.0F})[0].count, 0U);
}

}  // namespace
}  // namespace pogosim
