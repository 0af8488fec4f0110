#include "geometry/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.hpp"

namespace pogosim {
namespace {

Polygon const kSquare{{1, 2}, {5, 2}, {5, 6}, {1, 6}};
Polygon const kLetterL{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};

Polygon reversed(Polygon polygon) {
    std::ranges::reverse(polygon);
    return polygon;
}

TEST(Polygon, AreaIsPositiveClockwiseOnTheScreenAndNegativeTheOtherWay) {
    EXPECT_DOUBLE_EQ(signed_area(kSquare), 16.0);
    EXPECT_DOUBLE_EQ(signed_area(reversed(kSquare)), -16.0);
    EXPECT_DOUBLE_EQ(signed_area(kLetterL), 4.0);
}

TEST(Polygon, AreaOfRegularPolygonFollowsItsFormula) {
    for (int n : {3, 7, 64, 1000}) {
        Polygon polygon;
        for (int i = 0; i < n; ++i) {
            polygon.push_back(100.0F * direction(6.2831853F * static_cast<float>(i) / static_cast<float>(n)));
        }
        double const expected = 0.5 * n * 1.0e4 * std::sin(2.0 * std::numbers::pi / n);
        EXPECT_NEAR(signed_area(polygon), expected, 1.0e-5 * expected) << n;
    }
}

TEST(Polygon, CentroidOfLetterLIsTheWeightedMeanOfItsTwoBars) {
    // Bars: 2 x 1 at (1, 0.5) and 1 x 2 at (0.5, 2).
    Vec2 const middle = centroid(kLetterL);
    EXPECT_FLOAT_EQ(middle.x, 0.75F);
    EXPECT_FLOAT_EQ(middle.y, 1.25F);
    EXPECT_EQ(centroid(reversed(kLetterL)), middle);
}

TEST(Polygon, CentroidMovesWithThePolygonFarFromTheOrigin) {
    Polygon shifted = kSquare;
    for (Vec2& corner : shifted) {
        corner = corner + Vec2{100000.0F, -200000.0F};
    }
    EXPECT_EQ(centroid(shifted), (Vec2{100003.0F, -199996.0F}));
}

TEST(Polygon, NotchOfLetterLIsOutside) {
    EXPECT_TRUE(contains(kLetterL, {0.5F, 2.5F}));
    EXPECT_TRUE(contains(kLetterL, {1.5F, 0.5F}));
    EXPECT_FALSE(contains(kLetterL, {1.5F, 2.0F}));
    EXPECT_FALSE(contains(kLetterL, {-0.1F, 1.0F}));
    EXPECT_FALSE(contains(kLetterL, {0.5F, 3.5F}));
}

TEST(Polygon, PointAtTheHeightOfACornerIsJudgedRight) {
    Polygon const diamond{{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    EXPECT_TRUE(contains(diamond, {0.0F, 0.0F}));
    EXPECT_TRUE(contains(diamond, {-0.5F, 0.0F}));
    EXPECT_FALSE(contains(diamond, {-1.5F, 0.0F}));
    EXPECT_FALSE(contains(diamond, {1.5F, 0.0F}));
    EXPECT_FALSE(contains(diamond, {-0.5F, 1.0F}));
}

TEST(Polygon, ShareOfRandomPointsInsideIsTheShareOfTheArea) {
    RandomStream random(1, 2);
    int inside = 0;
    constexpr int draws = 100000;
    for (int i = 0; i < draws; ++i) {
        float const x = random.uniform(-1.0F, 3.0F);
        float const y = random.uniform(-1.0F, 4.0F);
        inside += contains(kLetterL, {x, y}) ? 1 : 0;
    }
    EXPECT_NEAR(inside, draws * 4.0 / 20.0, 5.0 * std::sqrt(draws * 0.2 * 0.8));
}

TEST(Polygon, DistanceToOutlineIsTheSameFromInsideAndOutside) {
    EXPECT_FLOAT_EQ(distance_to_outline(kSquare, {2, 4}), 1.0F);
    EXPECT_FLOAT_EQ(distance_to_outline(kSquare, {0, 4}), 1.0F);
    EXPECT_FLOAT_EQ(distance_to_outline(kSquare, {8, 10}), 5.0F);
    EXPECT_FLOAT_EQ(distance_to_outline(kSquare, {5, 3}), 0.0F);
}

TEST(Polygon, NearestPointOfASegmentStaysBetweenItsEnds) {
    EXPECT_EQ(nearest_on_segment({0, 0}, {10, 0}, {4, 3}), (Vec2{4, 0}));
    EXPECT_EQ(nearest_on_segment({0, 0}, {10, 0}, {-4, 3}), (Vec2{0, 0}));
    EXPECT_EQ(nearest_on_segment({0, 0}, {10, 0}, {14, 3}), (Vec2{10, 0}));
    EXPECT_EQ(nearest_on_segment({1, 1}, {1, 1}, {14, 3}), (Vec2{1, 1}));
}

TEST(Polygon, BoundingBoxHoldsAllCornersTightly) {
    Box const box = bounding_box(kLetterL);
    EXPECT_EQ(box.min, (Vec2{0, 0}));
    EXPECT_EQ(box.max, (Vec2{2, 3}));
}

}  // namespace
}  // namespace pogosim
