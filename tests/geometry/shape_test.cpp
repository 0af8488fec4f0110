#include "geometry/shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"

namespace pogosim {
namespace {

Shape const kDisk{.kind = ShapeKind::disk, .radius_mm = 26.5F};
Shape const kRectangle{.kind = ShapeKind::rectangle, .width_mm = 60.0F, .height_mm = 80.0F};
Shape const kTriangle{.kind = ShapeKind::triangle, .side_length_mm = 30.0F};
Shape const kGlobal{.kind = ShapeKind::global};
Shape const kArena{.kind = ShapeKind::arena};

double area_by_counting(Shape const& shape) {
    RandomStream random(3, 1);
    constexpr int draws = 200000;
    int inside = 0;
    for (int i = 0; i < draws; ++i) {
        float const x = random.uniform(-60.0F, 60.0F);
        float const y = random.uniform(-60.0F, 60.0F);
        inside += contains(shape, {x, y}) ? 1 : 0;
    }
    return 14400.0 * inside / draws;
}

TEST(Shape, BoundingRadiusIsThatOfTheSmallestDiskAroundTheOrigin) {
    EXPECT_FLOAT_EQ(bounding_radius(kDisk), 26.5F);
    EXPECT_FLOAT_EQ(bounding_radius(kRectangle), 50.0F);
    EXPECT_FLOAT_EQ(bounding_radius(kTriangle), 17.320508F);
    EXPECT_FLOAT_EQ(bounding_radius(kGlobal), 0.0F);
    EXPECT_FLOAT_EQ(bounding_radius(kArena), 0.0F);
}

TEST(Shape, InnerRadiusIsThatOfTheLargestDiskWithin) {
    EXPECT_FLOAT_EQ(inner_radius(kDisk), 26.5F);
    EXPECT_FLOAT_EQ(inner_radius(kRectangle), 0.5F * std::min(kRectangle.width_mm, kRectangle.height_mm));
    EXPECT_FLOAT_EQ(inner_radius(kTriangle), 0.5F * bounding_radius(kTriangle));
    EXPECT_FLOAT_EQ(inner_radius(kGlobal), 0.0F);
    EXPECT_FLOAT_EQ(inner_radius(kArena), 0.0F);
}

TEST(Shape, CountedAreaIsTheFormulasArea) {
    EXPECT_NEAR(area_by_counting(kDisk), 2206.2, 70.0);
    EXPECT_NEAR(area_by_counting(kRectangle), 4800.0, 80.0);
    EXPECT_NEAR(area_by_counting(kTriangle), 389.7, 30.0);
}

TEST(Shape, TrianglePointsTowardsNegativeY) {
    EXPECT_TRUE(contains(kTriangle, {0.0F, -17.0F}));
    EXPECT_FALSE(contains(kTriangle, {0.0F, -17.5F}));
    EXPECT_TRUE(contains(kTriangle, {14.5F, 8.5F}));
    EXPECT_TRUE(contains(kTriangle, {-14.5F, 8.5F}));
    EXPECT_FALSE(contains(kTriangle, {0.0F, 9.0F}));
    EXPECT_FALSE(contains(kTriangle, {10.0F, -10.0F}));
}

TEST(Shape, RectangleIsWideAlongXAndHighAlongY) {
    EXPECT_TRUE(contains(kRectangle, {29.0F, 39.0F}));
    EXPECT_FALSE(contains(kRectangle, {31.0F, 0.0F}));
    EXPECT_FALSE(contains(kRectangle, {0.0F, -41.0F}));
}

TEST(Shape, GlobalHoldsEveryPoint) {
    EXPECT_TRUE(contains(kGlobal, {1.0e9F, -1.0e9F}));
    EXPECT_TRUE(contains(kArena, {1.0e9F, -1.0e9F}));
}

TEST(Shape, BoundingBoxIsTheSmallestThatHoldsTheShape) {
    for (ShapeKind const kind : {ShapeKind::disk, ShapeKind::rectangle, ShapeKind::triangle}) {
        Shape const shape{.kind = kind, .radius_mm = 30, .width_mm = 70, .height_mm = 20, .side_length_mm = 90};
        Box const box = bounding_box(shape);
        // The extent of all points inside, on a grid of a quarter of a millimetre.
        Box extent;
        for (float x = -100.0F; x <= 100.0F; x += 0.25F) {
            for (float y = -100.0F; y <= 100.0F; y += 0.25F) {
                if (contains(shape, {x, y})) {
                    extent.min = {std::min(extent.min.x, x), std::min(extent.min.y, y)};
                    extent.max = {std::max(extent.max.x, x), std::max(extent.max.y, y)};
                }
            }
        }
        EXPECT_NEAR(box.min.x, extent.min.x, 0.5F);
        EXPECT_NEAR(box.min.y, extent.min.y, 0.5F);
        EXPECT_NEAR(box.max.x, extent.max.x, 0.5F);
        EXPECT_NEAR(box.max.y, extent.max.y, 0.5F);
    }
}

TEST(Shape, NothingOfAShapeIsBeyondItsBoundingRadius) {
    RandomStream random(4, 1);
    for (Shape const& shape : {kDisk, kRectangle, kTriangle}) {
        for (int i = 0; i < 20000; ++i) {
            float const x = random.uniform(-60.0F, 60.0F);
            float const y = random.uniform(-60.0F, 60.0F);
            EXPECT_TRUE(!contains(shape, {x, y}) || std::hypot(x, y) <= bounding_radius(shape) * 1.0001F);
        }
    }
}

}  // namespace
}  // namespace pogosim
