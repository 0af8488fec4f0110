#include "geometry/shape.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace

float bounding_radius(Shape const& shape) {
    switch (shape.kind) {
        case ShapeKind::disk:
            return shape.radius_mm;
        case ShapeKind::rectangle:
            return 0.5F * exact::hypot(shape.width_mm, shape.height_mm);
        case ShapeKind::triangle:
            return shape.side_length_mm / kSqrt3;
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
            return 0.5F * std::min(shape.width_mm, shape.height_mm);
        case ShapeKind::triangle:
            return shape.side_length_mm / (2.0F * kSqrt3);
        case ShapeKind::global:
        case ShapeKind::arena:
            break;
    }
    return 0.0F;
}

Polygon outline(Shape const& shape, int disk_corners) {
    switch (shape.kind) {
        case ShapeKind::disk: {
            Polygon corners;
            for (int i = 0; i < disk_corners; ++i) {
                float const turn = static_cast<float>(i) / static_cast<float>(disk_corners);
                corners.push_back(shape.radius_mm * direction(2.0F * std::numbers::pi_v<float> * turn));
            }
            return corners;
        }
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
        case ShapeKind::global:
        case ShapeKind::arena:
            break;
    }
    return {};
}

Box bounding_box(Shape const& shape) {
    switch (shape.kind) {
        case ShapeKind::disk: {
            Vec2 const half{shape.radius_mm, shape.radius_mm};
            return {-half, half};
        }
        case ShapeKind::rectangle: {
            Vec2 const half{0.5F * shape.width_mm, 0.5F * shape.height_mm};
            return {-half, half};
        }
        case ShapeKind::triangle: {
            float const circumradius = shape.side_length_mm / kSqrt3;
            return {{-0.5F * shape.side_length_mm, -circumradius}, {0.5F * shape.side_length_mm, 0.5F * circumradius}};
        }
        case ShapeKind::global:
        case ShapeKind::arena:
            break;
    }
    return {};
}

Shape inset(Shape const& shape, float inwards_mm) {
    Shape smaller = shape;
    smaller.radius_mm = std::max(shape.radius_mm - inwards_mm, 0.0F);
    smaller.width_mm = std::max(shape.width_mm - 2.0F * inwards_mm, 0.0F);
    smaller.height_mm = std::max(shape.height_mm - 2.0F * inwards_mm, 0.0F);
    smaller.side_length_mm = std::max(shape.side_length_mm - 2.0F * kSqrt3 * inwards_mm, 0.0F);
    return smaller;
}

bool contains(Shape const& shape, Vec2 offset_mm) {
    switch (shape.kind) {
        case ShapeKind::disk:
            return squared_length(offset_mm) <= shape.radius_mm * shape.radius_mm;
        case ShapeKind::rectangle:
            return std::abs(offset_mm.x) <= 0.5F * shape.width_mm && std::abs(offset_mm.y) <= 0.5F * shape.height_mm;
        case ShapeKind::triangle:
            return in_triangle(shape.side_length_mm, offset_mm);
        case ShapeKind::global:
        case ShapeKind::arena:
            break;
    }
    return true;
}

}  // namespace pogosim
