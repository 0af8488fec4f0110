// Shapes in a configuration: what they become, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "config_file.hpp"
#include "geometry/shape.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

std::string object(std::string const& keys) {
    return "objects:\n  o: {type: passive_object, x: 500, y: 500, " + keys + "}\n";
}

Shape shape_of(std::string const& keys) {
    return load(object(keys)).objects[0].spec.shape;
}

TEST(ShapeKeys, CapsuleIsAsLargeAsItsRectangle) {
    Shape const shape = shape_of("geometry: capsule, body_width: 60, body_height: 20");
    EXPECT_EQ(shape.kind, ShapeKind::capsule);
    EXPECT_FLOAT_EQ(bounding_radius(shape), 30.0F);
    EXPECT_FLOAT_EQ(inner_radius(shape), 10.0F);
}

TEST(ShapeKeys, PolygonHasItsCentreOfMassAtItsPosition) {
    for (char const* const corners : {"[[100, 100], [160, 100], [160, 140], [100, 140]]",
                                      "[[100, 140], [160, 140], [160, 100], [100, 100]]"}) {  // either way round
        Shape const shape = shape_of(std::string("geometry: polygon, corners: ") + corners);
        Box const box = bounding_box(shape);
        EXPECT_NEAR(box.min.x, -30.0F, 1e-4F);
        EXPECT_NEAR(box.max.y, 20.0F, 1e-4F);
        EXPECT_NEAR(moments_of(shape).area_mm2, 2400.0, 1e-2);
    }
}

TEST(ShapeKeys, CornerRadiusRoundsWithinTheSharpCorners) {
    double const cut_off = (4.0 - std::numbers::pi) * 25.0;
    Shape const box = shape_of("geometry: rectangle, body_width: 60, body_height: 40, corner_radius: 5");
    EXPECT_NEAR(moments_of(box).area_mm2, 2400.0 - cut_off, 0.1);
    EXPECT_NEAR(bounding_box(box).max.x, 30.0F, 1e-4F);
    EXPECT_FLOAT_EQ(bounding_radius(shape_of("geometry: disk, radius: 20, corner_radius: 500")), 20.0F);
}

TEST(ShapeKeys, CompoundHasItsPartsWhereTheyAreSaidToBe) {
    Shape const shape = shape_of(
        "geometry: compound, parts: [{geometry: rectangle, body_width: 100, body_height: 10}, "
        "{geometry: capsule, body_width: 60, body_height: 20, x: 50, y: 30, angle_deg: 90}]");
    ASSERT_EQ(shape.parts.size(), 2U);
    AreaMoments const all = moments_of(shape);
    EXPECT_NEAR(all.centre_mm().x, 0.0F, 1e-3F);
    EXPECT_NEAR(all.centre_mm().y, 0.0F, 1e-3F);
    Vec2 const apart = moments_of(shape.parts[1]).centre_mm() - moments_of(shape.parts[0]).centre_mm();
    EXPECT_NEAR(apart.x, 50.0F, 1e-3F);
    EXPECT_NEAR(apart.y, 30.0F, 1e-3F);
    Box const box = bounding_box(shape);
    EXPECT_NEAR(box.max.y - box.min.y, 5.0F + 60.0F, 1e-2F);  // upright: from -5 to 60
}

TEST(ShapeKeys, SizeOfAnotherShapeIsAWarningWhereTheOwnIsMissing) {
    auto const warnings_of = [](std::string const& keys) {
        Warnings const warnings;
        load(object(keys));
        return warnings.text().substr(0, warnings.text().find("x.yaml:1:"));  // a world without robots
    };
    EXPECT_EQ(warnings_of("geometry: capsule, radius: 26.5"),
              "x.yaml:2: objects.o.radius: is no size of this shape; body_width and body_height are missing, and 10 mm "
              "is taken\n");
    EXPECT_EQ(warnings_of("geometry: disk, body_width: 60"),
              "x.yaml:2: objects.o.body_width: is no size of this shape; radius is missing, and 10 mm is taken\n");
    EXPECT_EQ(warnings_of("geometry: capsule, body_width: 60, radius: 20"),
              "x.yaml:2: objects.o.radius: is no size of this shape; body_height is missing, and 10 mm is taken\n");
    EXPECT_NE(warnings_of("geometry: triangle, radius: 40").find("side_length is missing"), std::string::npos);
    EXPECT_EQ(warnings_of("geometry: disk, radius: 20, body_width: 60"), "");  // as before the disk was a box
    EXPECT_EQ(warnings_of("geometry: capsule"), "");
}

TEST(ShapeKeys, CoordinateNearZeroIsOrdinaryBesideLargeOnes) {
    auto const warns = [](std::string const& corners) {
        Warnings const warnings;
        load(object("geometry: polygon, corners: " + corners));
        return warnings.text().find("unusually small") != std::string::npos;
    };
    EXPECT_FALSE(warns("[[30, 0.5], [0, 30], [-30, -0.5], [0, -30]]"));
    EXPECT_TRUE(warns("[[0.03, 0], [0, 0.03], [-0.03, 0], [0, -0.03]]"));
}

TEST(ShapeKeys, MistakesAreNamedWithTheirLine) {
    auto const error = [](std::string const& keys) { return load_error(object(keys)); };
    std::string const at = "x.yaml:2: objects.o";
    std::string const corners = at + ".corners: ";
    EXPECT_EQ(error("geometry: polygon"),
              at + ": needs corners: a list of 3 to 8 corners, such as [[0, 0], [40, 0], [20, 30]] (mm)");
    EXPECT_EQ(
        error("geometry: polygon, corners: [[0, 0], [1, 1]]"),
        corners + "expected a list of 3 to 8 corners, such as [[0, 0], [40, 0], [20, 30]] (mm), found a list of 2");
    EXPECT_NE(error("geometry: polygon, corners: 3").find("expected a list of 3 to 8 corners"), std::string::npos);
    EXPECT_EQ(error("geometry: polygon, corners: [[0, 0], [40, 0], [10, 10], [0, 40]]"),
              corners +
                  "the polygon is not convex at (10, 10); build such a body from convex parts, with "
                  "geometry: compound");
    EXPECT_EQ(error("geometry: polygon, corners: [[0, 0], [40, 0], [40, 0], [0, 40]]"),
              corners + "corners 1 and 2 are the same");
    EXPECT_EQ(error("geometry: polygon, corners: [[0, 0], [40, 0], [80, 0]]"),
              corners + "these corners enclose no area");
    EXPECT_NE(error("geometry: polygon, corners: [[0, 0], [40, 40], [40, 0], [0, 39]]").find("cross or touch"),
              std::string::npos);
    EXPECT_NE(error("geometry: polygon, corners: [[0, 0], [40, x], [20, 30]]").find("objects.o.corners.1"),
              std::string::npos);
    // A pentagram turns to one side at each corner, too.
    EXPECT_NE(error("geometry: polygon, corners: [[0, -50], [29, 40], [-47, -15], [47, -15], [-29, 40]]")
                  .find("cross or touch"),
              std::string::npos);
    EXPECT_EQ(
        error("geometry: rectangle, body_width: 60, body_height: 30, corner_radius: 15"),
        at +
            ".corner_radius: expected at most 14.85 (mm), which leaves some of every side, found 15; for half circles, "
            "use "
            "geometry: capsule");
    EXPECT_EQ(error("geometry: rectangle, corner_radius: -1").substr(0, at.size() + 25),
              at + ".corner_radius: expected ");
    std::string const parts = at + ".parts";
    EXPECT_EQ(error("geometry: compound").substr(0, at.size() + 34), at + ": needs parts: a list of maps, suc");
    EXPECT_NE(error("geometry: compound, parts: []").find(parts + ": expected 1 to 16 entries, found 0"),
              std::string::npos);
    EXPECT_EQ(error("geometry: compound, parts: [{geometry: disk, radius: 20}, {geometry: disk, radius: 20, x: 30}, "
                    "{geometry: disk, radius: 20, x: 80.2}]"),
              parts +
                  ".2: is not connected to part 0, nor to a part that is: the nearest of these is 10.2 mm away; parts "
                  "have to overlap or touch");
    EXPECT_EQ(error("geometry: compound, parts: [{geometry: compound}]"),
              parts + ".0.geometry: expected one of disk, rectangle, capsule, triangle, polygon, found 'compound'");
    EXPECT_EQ(error("geometry: compound, parts: [{radius: 20}]"),
              parts + ".0: the key 'geometry' is missing; expected one of disk, rectangle, capsule, triangle, polygon");
    EXPECT_NE(error("geometry: compound, parts: [{geometry: polygon, corners: [[0, 0]]}]").find(parts + ".0.corners"),
              std::string::npos);
    EXPECT_EQ(load_error("objects:\n  m: {type: membrane, geometry: compound}\n"),
              "x.yaml:2: objects.m.geometry: expected one of disk, rectangle, capsule, triangle, polygon, found "
              "'compound'");
}

TEST(ShapeKeys, PartsMayTouchInAnyOrder) {
    EXPECT_EQ(load_error(object("geometry: compound, parts: [{geometry: disk, radius: 20}, "
                                "{geometry: disk, radius: 20, x: 80}, {geometry: disk, radius: 20, x: 40}]")),
              "no error");
}

/// However thin they are, and wherever they cross.
TEST(ShapeKeys, ThinPartsMayCross) {
    for (int i = -9; i <= 9; i += 3) {
        std::string const at = "x: " + std::to_string(0.37 * i) + ", y: " + std::to_string(3.9 - 0.71 * i);
        EXPECT_EQ(load_error(object("geometry: compound, parts: [{geometry: rectangle, body_width: 1000, "
                                    "body_height: 0.5}, {geometry: rectangle, body_width: 0.5, body_height: 1000, " +
                                    at + "}]")),
                  "no error")
            << at;
    }
}

TEST(ShapeKeys, LargestCornerRadiusThatIsNamedIsTaken) {
    std::string const corners = "geometry: polygon, corners: [[0, 0], [100, 0], [100, 100]], corner_radius: ";
    std::string const error = load_error(object(corners + "50"));
    std::string const named = error.substr(error.find("at most ") + 8);
    EXPECT_EQ(load_error(object(corners + named.substr(0, named.find(' ')))), "no error") << error;
    // A corner in the middle of a side counts for nothing.
    EXPECT_EQ(load_error(object("geometry: polygon, corner_radius: 5, corners: [[0, 0], [50, 0], [100, 0], [100, 100], "
                                "[0, 100]]")),
              "no error");
}

TEST(ShapeKeys, AngleInRadiansIsWarnedOf) {
    Warnings const warnings;
    (void)load(
        object("geometry: compound, parts: [{geometry: rectangle, body_width: 60, body_height: 10}, "
               "{geometry: rectangle, body_width: 60, body_height: 10, angle_deg: 1.5708}]"));
    EXPECT_NE(warnings.text().find("if you meant radians"), std::string::npos) << warnings.text();
}

}  // namespace
