// What a soft membrane encloses: it resists changes of its area like a cushion of water.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <numbers>

#include "base/vec2.hpp"

namespace pogosim {

/// The bodies of a membrane in their order along it, in either engine.
template <class T>
concept MembraneLine = requires(T line, std::size_t i, Vec2 change) {
    { line.size() } -> std::same_as<std::size_t>;
    { line.position(i) } -> std::same_as<Vec2>;
    { line.velocity(i) } -> std::same_as<Vec2>;
    { line.inverse_mass(i) } -> std::same_as<float>;
    line.push(i, change);  // adds to the velocity
};

/// A spring between the present and the initial area of a membrane, with the membrane's own mass, critically damped.
/// Solved as one soft constraint per step, which is stable at every stiffness: E. Catto, "Soft Constraints", Game
/// Developers Conference, 2011. Lengths in any unit.
class MembraneArea {
public:
    /// As stiff as a time step allows: a change of area is undone within a few steps.
    static constexpr float kStiff = 0.25F;

    /// Takes the present area as that at rest. `swings_per_step`: its stiffness, as a frequency.
    template <MembraneLine Line>
    explicit MembraneArea(Line const& line, float swings_per_step = kStiff)
        : area_(enclosed(line)), swings_per_step_(swings_per_step) {}

    /// Changes the velocities for a step of `dt_s`.
    template <MembraneLine Line>
    void push(Line const& line, float dt_s) const;

private:
    // No push while area and predicted area are within this tolerance: even a push of zero would keep the membrane
    // awake.
    static constexpr float kTolerance = 1e-4F;  // of the area

    template <MembraneLine Line>
    static std::size_t after(Line const& line, std::size_t i) {
        return i + 1 < line.size() ? i + 1 : 0;
    }

    /// Signed, positive when the bodies run clockwise on the screen.
    template <MembraneLine Line>
    static float enclosed(Line const& line) {
        float twice = 0.0F;
        for (std::size_t i = 0; i < line.size(); ++i) {
            twice += cross(line.position(i), line.position(after(line, i)));
        }
        return 0.5F * twice;
    }

    /// How the area grows when body i moves.
    template <MembraneLine Line>
    static Vec2 gradient(Line const& line, std::size_t i) {
        std::size_t const before = i > 0 ? i - 1 : line.size() - 1;
        Vec2 const across = line.position(after(line, i)) - line.position(before);
        return {0.5F * across.y, -0.5F * across.x};
    }

    float area_;  // at rest
    float swings_per_step_;
};

template <MembraneLine Line>
void MembraneArea::push(Line const& line, float dt_s) const {
    float inverse_mass = 0.0F;  // of the area as a generalised coordinate
    float growth = 0.0F;        // rate of change of the area
    for (std::size_t i = 0; i < line.size(); ++i) {
        Vec2 const way = gradient(line, i);
        inverse_mass += dot(way, way) * line.inverse_mass(i);
        growth += dot(way, line.velocity(i));
    }
    float const excess = enclosed(line) - area_;
    if (inverse_mass <= 0.0F || std::abs(excess) + std::abs(growth) * dt_s < kTolerance * std::abs(area_)) {
        return;
    }
    float const omega = 2.0F * std::numbers::pi_v<float> * swings_per_step_ / dt_s;
    float const stiffness = omega * omega / inverse_mass;
    float const damping = 2.0F * omega / inverse_mass;
    float const softness = 1.0F / (dt_s * (damping + dt_s * stiffness));
    float const bias = excess * dt_s * stiffness * softness;
    float const impulse = -(growth + bias) / (inverse_mass + softness);
    for (std::size_t i = 0; i < line.size(); ++i) {
        line.push(i, impulse * line.inverse_mass(i) * gradient(line, i));
    }
}

}  // namespace pogosim
