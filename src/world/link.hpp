// Links between bodies: springs, rods and hinges, as in robots in an elastic exoskeleton, chains and active solids.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "base/vec2.hpp"

namespace pogosim {

enum class LinkKind {
    spring,  // pulls along the line between its ends, in proportion to how much longer it is than at rest
    rod,     // keeps the distance of its ends
    hinge,   // keeps its ends together; the bodies turn about them
};

/// Holds a point of a body to a point of another one, or of the arena. Masses of bodies are in kg: body_density is in
/// kg per (100 mm)^2.
struct Link {
    LinkKind kind = LinkKind::spring;
    std::uint32_t a = 0;                                          // index into World::bodies
    std::uint32_t b = std::numeric_limits<std::uint32_t>::max();  // the same; kNone: the arena
    Vec2 end_a_mm;                                                // in the body's own frame
    Vec2 end_b_mm;                                                // the same; with kNone: a place in the arena
    float length_mm = 0.0F;                                       // at rest; of a hinge: 0
    float stiffness_n_m = 0.0F;                                   // of a spring
    float damping_n_s_m = 0.0F;                                   // of a spring, along it
    float breaking_n = std::numeric_limits<float>::infinity();    // it is cut by a force that is larger
    // How far `b` may turn against `a` about a hinge, rad; 0 is how they stood when they were linked.
    float least_rad = -std::numeric_limits<float>::infinity();
    float most_rad = std::numeric_limits<float>::infinity();
    float rest_rad = 0.0F;            // of a hinge: heading of `b`, or 0, less that of `a`, when it was made
    std::uint32_t link_category = 0;  // index into World::link_categories
    bool is_cut = false;              // it does nothing any more
    float tension_n = 0.0F;           // force in the last step: positive when it pulls; of a hinge: its magnitude

    friend bool operator==(Link const&, Link const&) = default;
};

/// The links under one name of the configuration.
struct LinkCategory {
    std::string name;
    bool are_drawn = true;

    friend bool operator==(LinkCategory const&, LinkCategory const&) = default;
};

}  // namespace pogosim
