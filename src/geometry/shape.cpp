#include "geometry/shape.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/exact_math.hpp"

namespace pogosim {

namespace {

constexpr float kSqrt3 = std::numbers::sqrt3_v<float>;

bool in_triangle(float side_mm, Vec2 offset_mm) {
    // The inscribed circle touches the middle of each side; a point is inside when it is beyond none of the three.
    float const inradius = side_mm / (2.0F * kSqrt3);
    Vec2 const outward[] = {{0.0F, 1.0F}, {0.5F * kSqrt3, -0.5F}, {-0.5F * kSqrt3, -0.5F}};
    return std::ranges::all_of(outward, [&](Vec2 normal) { return dot(offset_mm, normal) <= inradius; });
}

/// The rounding of corners leaves the sharp polygon around it.
RoundedPolygon rounded(Polygon const& sharp, float radius_mm) {
    return {inset(sharp, radius_mm), radius_mm};
}

RoundedPolygon capsule(float width_mm, float height_mm) {
    float const radius_mm = 0.5F * std::min(width_mm, height_mm);
    Vec2 const end{0.5F * width_mm - radius_mm, 0.5F * height_mm - radius_mm};
    return {end == Vec2{} ? Polygon{{}} : Polygon{-end, end}, radius_mm};
}

/// Radius of the largest disk around its centre of mass.
float half_thickness_mm(RoundedPolygon const& part) {
    bool const has_core = part.corners_mm.size() > 2;
    return part.radius_mm + (has_core ? distance_to_outline(part.corners_mm, moments_of(part).centre_mm()) : 0.0F);
}

/// Whether the formulas for sharp corners hold.
bool is_sharp(Shape const& shape) {
    return !has_corners(shape) || shape.corner_radius_mm == 0.0F;
}

float reach_of_parts_mm(Shape const& shape) {
    float farthest_mm = 0.0F;
    for (RoundedPolygon const& part : convex_parts(shape)) {
        for (Vec2 const corner : part.corners_mm) {
            farthest_mm = std::max(farthest_mm, exact::hypot(corner.x, corner.y) + part.radius_mm);
        }
    }
    return farthest_mm;
}

Polygon sharp_corners(Shape const& shape) {
    switch (shape.kind) {
        case ShapeKind::rectangle: {
            Vec2 const half{0.5F * shape.width_mm, 0.5F * shape.height_mm};
            return {{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}};
        }
        case ShapeKind::triangle: {
            float const height = 0.5F * kSqrt3 * shape.side_length_mm;
            return {{0.0F, -2.0F / 3.0F * height},
                    {0.5F * shape.side_length_mm, height / 3.0F},
                    {-0.5F * shape.side_length_mm, height / 3.0F}};
        }
        default:
            return shape.corners_mm;
    }
}

}  // namespace

Shape centred(Shape const& shape) {
    Shape result = shape;
    if (shape.kind == ShapeKind::polygon || shape.kind == ShapeKind::compound) {
        Vec2 const centre_mm = moments_of(shape).centre_mm();
        for (Vec2& corner : result.corners_mm) {
            corner = corner - centre_mm;
        }
        for (RoundedPolygon& part : result.parts) {
            part = moved(part, -centre_mm, 0.0F);
        }
    }
    return result;
}

std::vector<RoundedPolygon> convex_parts(Shape const& shape) {
    switch (shape.kind) {
        case ShapeKind::disk:
            return {{.corners_mm = {{}}, .radius_mm = shape.radius_mm}};
        case ShapeKind::capsule:
            return {capsule(shape.width_mm, shape.height_mm)};
        case ShapeKind::rectangle:
        case ShapeKind::triangle:
        case ShapeKind::polygon:
            return {rounded(sharp_corners(shape), shape.corner_radius_mm)};
        case ShapeKind::compound:
            return shape.parts;
        case ShapeKind::global:
        case ShapeKind::arena:
            break;
    }
    return {};
}

AreaMoments moments_of(Shape const& shape) {
    AreaMoments sum;
    for (RoundedPolygon const& part : convex_parts(shape)) {
        sum = sum + moments_of(part);
    }
    return sum;
}

float largest_corner_radius(Shape const& shape) {
    constexpr float share = 0.99F;  // of that of the smallest disk that touches three sides
    Polygon const corners = sharp_corners(shape);
    float low = 0.0F;
    float high = length(bounding_box(corners).size());
    for (int step = 0; step < 40; ++step) {
        float const middle = 0.5F * (low + high);
        (inset(corners, middle).size() == corners.size() ? low : high) = middle;
    }
    return share * low;
}

float bounding_radius(Shape const& shape) {
    if (!is_sharp(shape)) {
        return reach_of_parts_mm(shape);
    }
    switch (shape.kind) {
        case ShapeKind::disk:
            return shape.radius_mm;
        case ShapeKind::rectangle:
            return 0.5F * exact::hypot(shape.width_mm, shape.height_mm);
        case ShapeKind::triangle:
            return shape.side_length_mm / kSqrt3;
        case ShapeKind::capsule:
            return 0.5F * std::max(shape.width_mm, shape.height_mm);
        case ShapeKind::polygon:
        case ShapeKind::compound:
            return reach_of_parts_mm(shape);
        case ShapeKind::global:
        case ShapeKind::arena:
            break;
    }
    return 0.0F;
}

float inner_radius(Shape const& shape) {
    switch (shape.kind) {
        case ShapeKind::disk:
            return shape.radius_mm;
        case ShapeKind::rectangle:
        case ShapeKind::capsule:
            return 0.5F * std::min(shape.width_mm, shape.height_mm);
        case ShapeKind::triangle:
            return shape.side_length_mm / (2.0F * kSqrt3);
        case ShapeKind::polygon:
            return distance_to_outline(shape.corners_mm, {});
        case ShapeKind::compound:
            return half_thickness_mm(*std::ranges::min_element(shape.parts, {}, half_thickness_mm));
        case ShapeKind::global:
        case ShapeKind::arena:
            break;
    }
    return 0.0F;
}

Polygon outline(Shape const& shape, int disk_corners) {
    assert(shape.kind != ShapeKind::compound);
    std::vector<Polygon> const all = outlines(shape, disk_corners);
    return all.empty() ? Polygon() : all.front();
}

std::vector<Polygon> outlines(Shape const& shape, int disk_corners) {
    std::vector<Polygon> all;
    for (RoundedPolygon const& part : convex_parts(shape)) {
        all.push_back(outline(part, disk_corners));
    }
    return all;
}

float reach(Shape const& shape, Vec2 towards) {
    if (shape.kind == ShapeKind::disk) {
        return shape.radius_mm;
    }
    constexpr float rounding = 1e-5F;
    float farthest_mm = 0.0F;
    for (Polygon const& corners : outlines(shape)) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
            Vec2 const from = corners[i];
            Vec2 const side = corners[(i + 1) % corners.size()] - from;
            float const turn = cross(towards, side);
            if (turn != 0.0F) {
                float const along_side = cross(from, towards) / turn;
                if (along_side >= -rounding && along_side <= 1.0F + rounding) {
                    farthest_mm = std::max(farthest_mm, cross(from, side) / turn);
                }
            }
        }
    }
    return farthest_mm;
}

Box bounding_box(Shape const& shape) {
    Box box{};
    bool is_first = true;
    for (RoundedPolygon const& part : convex_parts(shape)) {
        Box const own = bounding_box(part.corners_mm);
        Vec2 const margin{part.radius_mm, part.radius_mm};
        Box const wider{own.min - margin, own.max + margin};
        box = is_first ? wider
                       : Box{{std::min(box.min.x, wider.min.x), std::min(box.min.y, wider.min.y)},
                             {std::max(box.max.x, wider.max.x), std::max(box.max.y, wider.max.y)}};
        is_first = false;
    }
    return box;
}

Shape inset(Shape const& shape, float inwards_mm) {
    Shape smaller = shape;
    smaller.radius_mm = std::max(shape.radius_mm - inwards_mm, 0.0F);
    smaller.width_mm = std::max(shape.width_mm - 2.0F * inwards_mm, 0.0F);
    smaller.height_mm = std::max(shape.height_mm - 2.0F * inwards_mm, 0.0F);
    smaller.side_length_mm = std::max(shape.side_length_mm - 2.0F * kSqrt3 * inwards_mm, 0.0F);
    smaller.corners_mm = inset(shape.corners_mm, inwards_mm);
    bool const rounds = shape.corner_radius_mm > 0.0F || (shape.kind == ShapeKind::polygon && inwards_mm < 0.0F);
    smaller.corner_radius_mm = rounds ? std::max(shape.corner_radius_mm - inwards_mm, 0.0F) : 0.0F;
    if (shape.kind == ShapeKind::polygon && smaller.corners_mm.empty()) {
        smaller = {.kind = ShapeKind::disk, .radius_mm = 0.0F};
    }
    for (RoundedPolygon& part : smaller.parts) {
        part.radius_mm += std::max(-inwards_mm, 0.0F);
    }
    return smaller;
}

bool contains(Shape const& shape, Vec2 offset_mm) {
    if (!is_sharp(shape)) {
        return contains(convex_parts(shape).front(), offset_mm);
    }
    switch (shape.kind) {
        case ShapeKind::disk:
            return squared_length(offset_mm) <= shape.radius_mm * shape.radius_mm;
        case ShapeKind::rectangle:
            return std::abs(offset_mm.x) <= 0.5F * shape.width_mm && std::abs(offset_mm.y) <= 0.5F * shape.height_mm;
        case ShapeKind::triangle:
            return in_triangle(shape.side_length_mm, offset_mm);
        case ShapeKind::capsule:
        case ShapeKind::polygon:
        case ShapeKind::compound:
            return std::ranges::any_of(convex_parts(shape),
                                       [&](RoundedPolygon const& part) { return contains(part, offset_mm); });
        case ShapeKind::global:
        case ShapeKind::arena:
            break;
    }
    return true;
}

}  // namespace pogosim
