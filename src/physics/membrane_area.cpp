#include "physics/membrane_area.hpp"

#include <cmath>
#include <numbers>

namespace pogosim {

namespace {

// As stiff as the time step allows: a lost area is back within a few steps.
constexpr float kSwingsPerStep = 0.25F;
// A membrane whose area is and stays as right as this is left alone: a push, even of nothing, would keep it from sleep.
constexpr float kTolerance = 1e-4F;  // of the area

b2Vec2 position(std::vector<b2Body*> const& membrane, std::size_t i) {
    return membrane[i % membrane.size()]->GetWorldCenter();
}

/// Signed, positive when the bodies run clockwise on the screen.
float enclosed_area(std::vector<b2Body*> const& membrane) {
    float twice = 0.0F;
    for (std::size_t i = 0; i < membrane.size(); ++i) {
        twice += b2Cross(position(membrane, i), position(membrane, i + 1));
    }
    return 0.5F * twice;
}

/// How the area grows when body i moves.
b2Vec2 area_gradient(std::vector<b2Body*> const& membrane, std::size_t i) {
    b2Vec2 const across = position(membrane, i + 1) - position(membrane, i + membrane.size() - 1);
    return {0.5F * across.y, -0.5F * across.x};
}

}  // namespace

MembraneArea::MembraneArea(Membrane const& membrane, std::vector<b2Body*> const& bodies)
    : bodies_(bodies.begin() + membrane.body, bodies.begin() + membrane.body + membrane.body_count),
      area_(enclosed_area(bodies_)) {}

void MembraneArea::push(float dt_s) const {
    if (!bodies_.front()->IsAwake()) {
        return;  // joints let all of them sleep together
    }
    float inverse_mass = 0.0F;  // of the area as a coordinate
    float growth = 0.0F;        // of the area, per second
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        b2Vec2 const gradient = area_gradient(bodies_, i);
        inverse_mass += b2Dot(gradient, gradient) / bodies_[i]->GetMass();
        growth += b2Dot(gradient, bodies_[i]->GetLinearVelocity());
    }
    float const excess = enclosed_area(bodies_) - area_;
    if (inverse_mass <= 0.0F || std::abs(excess) + std::abs(growth) * dt_s < kTolerance * std::abs(area_)) {
        return;
    }
    float const omega = 2.0F * std::numbers::pi_v<float> * kSwingsPerStep / dt_s;
    float const stiffness = omega * omega / inverse_mass;
    float const damping = 2.0F * omega / inverse_mass;
    float const softness = 1.0F / (dt_s * (damping + dt_s * stiffness));
    float const bias = excess * dt_s * stiffness * softness;
    float const impulse = -(growth + bias) / (inverse_mass + softness);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        b2Vec2 const change = (impulse / bodies_[i]->GetMass()) * area_gradient(bodies_, i);
        bodies_[i]->SetLinearVelocity(bodies_[i]->GetLinearVelocity() + change);
    }
}

}  // namespace pogosim
