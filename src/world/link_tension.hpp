// What pulls at bodies.
#pragma once

#include <cmath>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// For each body, the tension of its link with the largest one, whether that pulls (positive) or pushes, N; 0 without
/// links.
inline std::vector<float> tensions_of_bodies(World const& world) {
    std::vector<float> tension_n(world.bodies.size(), 0.0F);
    for (Link const& link : world.links) {
        for (std::uint32_t const body : {link.a, link.b}) {
            if (!link.is_cut && body != kNone && std::abs(link.tension_n) > std::abs(tension_n[body])) {
                tension_n[body] = link.tension_n;
            }
        }
    }
    return tension_n;
}

}  // namespace pogosim
