#include "geometry/rounded_polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "geometry/shape.hpp"

namespace pogosim {
namespace {

constexpr double kPi = std::numbers::pi;

Polygon const kBox{{-20.0F, -10.0F}, {20.0F, -10.0F}, {20.0F, 10.0F}, {-20.0F, 10.0F}};
Polygon const kKite{{-30.0F, 0.0F}, {0.0F, -12.0F}, {25.0F, -4.0F}, {8.0F, 22.0F}};

/// By counting points on a fine raster.
AreaMoments counted(RoundedPolygon const& part) {
    constexpr double step = 0.2;
    AreaMoments sum;
    for (double y = -80.0 + step / 2; y < 80.0; y += step) {
        for (double x = -80.0 + step / 2; x < 80.0; x += step) {
            if (contains(part, {static_cast<float>(x), static_cast<float>(y)})) {
                double const area = step * step;
                sum = sum + AreaMoments{area, area * x, area * y, area * (x * x + y * y)};
            }
        }
    }
    return sum;
}

void expect_near(AreaMoments const& a, AreaMoments const& b, double share) {
    EXPECT_NEAR(a.area_mm2, b.area_mm2, share * b.area_mm2);
    EXPECT_NEAR(a.x_mm3, b.x_mm3, share * b.area_mm2 * 30.0);
    EXPECT_NEAR(a.y_mm3, b.y_mm3, share * b.area_mm2 * 30.0);
    EXPECT_NEAR(a.polar_mm4, b.polar_mm4, share * b.polar_mm4);
}

TEST(RoundedPolygon, MomentsOfDisksAndCapsulesAreThoseOfTheFormulas) {
    AreaMoments const disk = moments_of(RoundedPolygon{{{30.0F, -40.0F}}, 10.0F});
    EXPECT_NEAR(disk.area_mm2, kPi * 100.0, 1e-9);
    EXPECT_NEAR(disk.centre_mm().x, 30.0F, 1e-5F);
    EXPECT_NEAR(disk.centre_mm().y, -40.0F, 1e-5F);
    EXPECT_NEAR(disk.polar_mm4, kPi * 100.0 * (50.0 + 2500.0), 1e-6);
    // Rectangle 40 x 20 and two halves of a disk, whose centres of mass are 4 r / (3 pi) from the middle of the disk.
    AreaMoments const capsule = moments_of(RoundedPolygon{{{-20.0F, 0.0F}, {20.0F, 0.0F}}, 10.0F});
    double const far = 4.0 * 10.0 / (3.0 * kPi);
    double const ends = kPi * 100.0 * (50.0 - far * far + (20.0 + far) * (20.0 + far));
    EXPECT_NEAR(capsule.area_mm2, 800.0 + kPi * 100.0, 1e-4);
    EXPECT_NEAR(capsule.polar_mm4, 800.0 * (1600.0 + 400.0) / 12.0 + ends, 1e-9 * ends);
    EXPECT_NEAR(capsule.x_mm3, 0.0, 1e-6);
}

TEST(RoundedPolygon, MomentsAreThoseOfTheCountedArea) {
    for (float const radius_mm : {0.0F, 8.0F, 15.0F}) {
        for (Polygon const& corners : {kBox, kKite, Polygon{{5.0F, 5.0F}}, Polygon{{-10.0F, 3.0F}, {22.0F, 9.0F}}}) {
            RoundedPolygon const part{corners, radius_mm};
            if (corners.size() > 2 || radius_mm > 0.0F) {
                expect_near(moments_of(part), counted(part), 0.006);
            }
        }
    }
}

TEST(RoundedPolygon, OutlineEnclosesItsAreaAndIsItsRadiusFromTheCorners) {
    for (Polygon const& corners : {kBox, kKite, Polygon{{5.0F, 5.0F}}, Polygon{{-10.0F, 3.0F}, {22.0F, 9.0F}}}) {
        RoundedPolygon const part{corners, 7.0F};
        Polygon const line = outline(part, 512);
        EXPECT_NEAR(signed_area(line), moments_of(part).area_mm2, 0.02);
        for (Vec2 const point : line) {
            EXPECT_NEAR(distance_to_outline(corners, point), 7.0F, 1e-4F);
        }
    }
    EXPECT_EQ(outline(RoundedPolygon{kKite, 0.0F}, 128), kKite);
}

TEST(RoundedPolygon, InsetKeepsTheDistanceFromEverySide) {
    Polygon const smaller = inset(kBox, 4.0F);
    EXPECT_NEAR(signed_area(smaller), 32.0 * 12.0, 1e-3);
    for (Vec2 const corner : inset(kKite, 3.0F)) {
        EXPECT_NEAR(distance_to_outline(kKite, corner), 3.0F, 1e-4F);
        EXPECT_TRUE(contains(kKite, corner));
    }
    // Outwards and back again.
    Polygon const again = inset(inset(kKite, -5.0F), 5.0F);
    ASSERT_EQ(again.size(), kKite.size());
    EXPECT_NEAR(signed_area(again), signed_area(kKite), 1e-2);
    // A roof whose short top is cut off, and what is cut off as a whole.
    Polygon const roof{{-30.0F, 20.0F}, {-1.0F, -20.0F}, {1.0F, -20.0F}, {30.0F, 20.0F}};
    EXPECT_EQ(inset(roof, 8.0F).size(), 3U);
    EXPECT_TRUE(inset(kBox, 10.5F).empty());
}

Shape polygon(Polygon const& corners, float corner_radius_mm = 0.0F) {
    Shape shape{.kind = ShapeKind::polygon};
    shape.corners_mm = corners;
    shape.corner_radius_mm = corner_radius_mm;
    return centred(shape);
}

Shape u_shape() {
    Shape shape{.kind = ShapeKind::compound};
    RoundedPolygon const bar{{{-30.0F, -5.0F}, {30.0F, -5.0F}, {30.0F, 5.0F}, {-30.0F, 5.0F}}, 0.0F};
    shape.parts = {moved(bar, {0.0F, -35.0F}, 0.0F), moved(bar, {0.0F, 35.0F}, 0.0F),
                   moved(bar, {-35.0F, 0.0F}, 0.5F * std::numbers::pi_v<float>)};
    return centred(shape);
}

TEST(Compound, HasItsCentreOfMassInTheOrigin) {
    AreaMoments const moments = moments_of(u_shape());
    EXPECT_NEAR(moments.area_mm2, 1800.0, 1e-2);
    EXPECT_NEAR(moments.centre_mm().x, 0.0F, 1e-4F);
    EXPECT_NEAR(moments.centre_mm().y, 0.0F, 1e-4F);
    // The middle of the bars in the frame of the configuration was (-35 / 3, 0).
    double const own = 600.0 * (3600.0 + 100.0) / 12.0;
    double const x = 35.0 / 3.0;
    double const expected = 3.0 * own + 1200.0 * (35.0 * 35.0 + x * x) + 600.0 * (35.0 - x) * (35.0 - x);
    EXPECT_NEAR(moments.polar_mm4, expected, 1e-5 * expected);
}

TEST(Compound, HoldsWhatItsPartsHold) {
    Shape const u = u_shape();
    EXPECT_FALSE(contains(u, {0.0F, 0.0F}));
    EXPECT_TRUE(contains(u, {10.0F, 35.0F}));
    EXPECT_TRUE(contains(u, {10.0F, -35.0F}));
    EXPECT_TRUE(contains(u, {-35.0F + 35.0F / 3.0F, 0.0F}));
    EXPECT_EQ(outlines(u).size(), 3U);
    EXPECT_FLOAT_EQ(inner_radius(u), 5.0F);
    Box const box = bounding_box(u);
    EXPECT_NEAR(box.max.x - box.min.x, 70.0F, 1e-3F);
    EXPECT_NEAR(box.max.y - box.min.y, 80.0F, 1e-3F);
    Shape const wider = inset(u, -2.0F);
    EXPECT_NEAR(moments_of(wider).area_mm2, 3.0 * (64.0 * 14.0 - (4.0 - kPi) * 4.0), 1e-1);
    EXPECT_EQ(inset(u, 2.0F).parts, u.parts);
}

TEST(RoundedShape, StaysWithinTheSharpOne) {
    for (Shape sharp : {Shape{.kind = ShapeKind::rectangle, .width_mm = 60.0F, .height_mm = 30.0F},
                        Shape{.kind = ShapeKind::triangle, .side_length_mm = 50.0F}, polygon(kKite)}) {
        Shape round = sharp;
        round.corner_radius_mm = 0.5F * largest_corner_radius(sharp);
        EXPECT_GT(round.corner_radius_mm, 1.0F);
        EXPECT_LT(bounding_radius(round), bounding_radius(sharp));
        EXPECT_FLOAT_EQ(inner_radius(round), inner_radius(sharp));
        RandomStream random(5, 0);
        int cut_off = 0;
        for (int i = 0; i < 5000; ++i) {
            Vec2 const point{random.uniform(-40.0F, 40.0F), random.uniform(-40.0F, 40.0F)};
            cut_off += contains(sharp, point) && !contains(round, point) ? 1 : 0;
            EXPECT_FALSE(contains(round, point) && !contains(sharp, point));
        }
        EXPECT_GT(cut_off, 0);
    }
}

TEST(RoundedShape, LargestRadiusIsAHundredthBelowThatOfTheSmallestDiskThatTouchesThreeSides) {
    EXPECT_NEAR(largest_corner_radius({.kind = ShapeKind::rectangle, .width_mm = 60.0F, .height_mm = 30.0F}),
                0.99F * 15.0F, 1e-3F);
    float const inradius_mm = 50.0F / (2.0F * std::numbers::sqrt3_v<float>);
    EXPECT_NEAR(largest_corner_radius({.kind = ShapeKind::triangle, .side_length_mm = 50.0F}), 0.99F * inradius_mm,
                1e-3F);
}

TEST(Capsule, IsWhatItsSizesSay) {
    Shape const capsule{.kind = ShapeKind::capsule, .width_mm = 20.0F, .height_mm = 60.0F};
    EXPECT_FLOAT_EQ(bounding_radius(capsule), 30.0F);
    EXPECT_FLOAT_EQ(inner_radius(capsule), 10.0F);
    EXPECT_TRUE(contains(capsule, {0.0F, 29.9F}));
    EXPECT_FALSE(contains(capsule, {9.0F, 29.0F}));
    EXPECT_NEAR(moments_of(capsule).area_mm2, 800.0 + kPi * 100.0, 1e-3);
    EXPECT_EQ(inset(capsule, 3.0F).width_mm, 14.0F);
    Shape const disk{.kind = ShapeKind::capsule, .width_mm = 20.0F, .height_mm = 20.0F};
    EXPECT_NEAR(moments_of(disk).area_mm2, kPi * 100.0, 1e-3);
}

}  // namespace
}  // namespace pogosim
