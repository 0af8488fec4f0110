// Convex polygons with rounded corners, of which rigid bodies are made.
#pragma once

#include "geometry/polygon.hpp"

namespace pogosim {

/// All points within `radius_mm` of a convex polygon, whose corners run clockwise on the screen. With one corner it is
/// a disk, with two a capsule.
struct RoundedPolygon {
    Polygon corners_mm;
    float radius_mm = 0.0F;

    friend bool operator==(RoundedPolygon const&, RoundedPolygon const&) = default;
};

/// What a homogeneous sheet has by its form alone.
struct AreaMoments {
    double area_mm2 = 0.0;
    double x_mm3 = 0.0;  // area times the centre of mass
    double y_mm3 = 0.0;
    double polar_mm4 = 0.0;  // second moment about the origin

    Vec2 centre_mm() const { return {static_cast<float>(x_mm3 / area_mm2), static_cast<float>(y_mm3 / area_mm2)}; }
};

AreaMoments operator+(AreaMoments const& a, AreaMoments const& b);

AreaMoments moments_of(RoundedPolygon const& part);

/// Its border as a polygon. A full turn of rounding has `disk_corners` corners, those of a disk from +x on.
Polygon outline(RoundedPolygon const& part, int disk_corners);

bool contains(RoundedPolygon const& part, Vec2 point_mm);

/// Turned by the angle around the origin, then moved.
RoundedPolygon moved(RoundedPolygon const& part, Vec2 offset_mm, float turn_rad);

/// The convex polygon with every side moved inwards by so much, mm (outwards when negative, and to sharp corners).
/// Sides that are cut off are gone; a polygon that is cut off as a whole is empty.
Polygon inset(Polygon const& corners_mm, float inwards_mm);

}  // namespace pogosim
