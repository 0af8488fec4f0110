// Bodies that joints and links hold together, as those of a membrane are: they are always in one island.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// Indices into the world.
struct Assembly {
    std::vector<std::uint32_t> bodies;  // ascending; none of them is fixed
    std::vector<std::uint32_t> membranes;
    std::vector<std::uint32_t> hinges;  // joints of its membranes
    std::vector<std::uint32_t> links;   // that are not cut

    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.bodies, self.membranes, self.hinges, self.links);
    }
};

/// Impulses of a hinge or link in the last sub-step, which are the initial guess for the next one.
struct HeldImpulse {
    Vec2 push;               // of a rod, or of a spring's damping: the first number, along it
    float least = 0.0F;      // >= 0; of the limits of a hinge
    float most = 0.0F;       // <= 0
    float angle_rad = 0.0F;  // of a hinge with limits: how far it is turned
};

class Assemblies {
public:
    explicit Assemblies(World const& world);

    /// Follows links that were made or cut. Returns whether any were.
    bool follow(World const& world);

    /// Sorted by their first bodies.
    std::span<Assembly const> all() const { return assemblies_; }

    /// For each body: the first one of its assembly, or itself.
    std::vector<std::uint32_t> const& first_bodies() const { return first_body_; }

    /// Bodies with a hinge between them do not collide: they may overlap about it.
    bool may_collide(std::uint32_t a, std::uint32_t b) const;

    HeldImpulse& impulse_of_joint(std::uint32_t joint) { return impulses_[joint]; }
    HeldImpulse& impulse_of_link(std::uint32_t link) { return impulses_[joint_count_ + link]; }

    /// What later steps depend on, see state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.assemblies_, self.first_body_, self.place_, self.hinged_, self.impulses_, self.link_changes_);
    }

private:
    void find(World const& world);
    Assembly& of(std::uint32_t body);

    std::vector<Assembly> assemblies_;
    std::vector<std::uint32_t> first_body_;
    std::vector<std::uint32_t> place_;   // of each first body, in assemblies_
    std::vector<std::uint64_t> hinged_;  // pairs of bodies, sorted
    std::vector<HeldImpulse> impulses_;  // of all joints, then of all links of the world
    std::size_t joint_count_ = 0;
    std::uint32_t link_changes_ = 0;  // that have been followed
};

/// Cuts the links whose tension in the last step was more than they bear.
void break_links(World& world);

}  // namespace pogosim
