// Plane vectors. The frame of the whole project: millimetres, x to the right, y down, angles in radians and
// clockwise on the screen (from +x to +y).
#pragma once

#include <cmath>
#include <numbers>

#include "base/exact_math.hpp"

namespace pogosim {

struct Vec2 {
    float x = 0.0F;
    float y = 0.0F;

    friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
    friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
    friend constexpr Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
    friend constexpr Vec2 operator*(float s, Vec2 a) { return {s * a.x, s * a.y}; }
    friend constexpr Vec2 operator*(Vec2 a, float s) { return {s * a.x, s * a.y}; }
    friend constexpr bool operator==(Vec2 a, Vec2 b) = default;
};

constexpr float dot(Vec2 a, Vec2 b) {
    return a.x * b.x + a.y * b.y;
}

/// z component of the cross product: positive when b is clockwise (on the screen) of a.
constexpr float cross(Vec2 a, Vec2 b) {
    return a.x * b.y - a.y * b.x;
}

constexpr float squared_length(Vec2 a) {
    return dot(a, a);
}
inline float length(Vec2 a) {
    return std::sqrt(squared_length(a));
}

inline bool is_finite(Vec2 a) {
    return std::isfinite(a.x) && std::isfinite(a.y);
}

/// Unit vector at `angle_rad` from +x, clockwise on the screen.
constexpr Vec2 direction(float angle_rad) {
    exact::SineCosine const exact = exact::sine_cosine(static_cast<double>(angle_rad));
    return {static_cast<float>(exact.cosine), static_cast<float>(exact.sine)};
}

/// `a` turned by the angle whose unit vector is `unit`.
constexpr Vec2 rotate(Vec2 a, Vec2 unit) {
    return {a.x * unit.x - a.y * unit.y, a.x * unit.y + a.y * unit.x};
}

/// The same angle in (-pi, pi].
inline float wrap_angle(float angle_rad) {
    constexpr float pi = std::numbers::pi_v<float>;
    if (angle_rad > -pi && angle_rad <= pi) {
        return angle_rad;
    }
    float const turned = std::remainder(angle_rad, 2.0F * pi);
    return turned <= -pi ? turned + 2.0F * pi : turned;
}

/// Axis-aligned rectangle.
struct Box {
    Vec2 min;
    Vec2 max;

    friend constexpr bool operator==(Box const&, Box const&) = default;

    constexpr Vec2 size() const { return max - min; }
    constexpr Vec2 centre() const { return 0.5F * (min + max); }
    constexpr bool contains(Vec2 point) const {
        return point.x >= min.x && point.x <= max.x && point.y >= min.y && point.y <= max.y;
    }
};

}  // namespace pogosim
