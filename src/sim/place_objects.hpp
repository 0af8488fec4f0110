// Where the objects of a configuration stand at time 0.
#pragma once

#include <cstdint>
#include <vector>

#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Poses of the objects of every entry of `scenario.objects`, in its order; none for lamps. Entries with x and y, or
/// with poses, stand there with the headings given (0 without one). Formations place the other bodies and keep off what
/// stands already: first the categories with an area or a formation of their own, then the one that bounds the
/// formation (initial_formation_root_object), then all others together. `world` has its arena and no objects. Throws
/// ConfigError, naming the object and the key, for what lies outside of the arena, does not fit into it, or cannot
/// bound a formation.
std::vector<std::vector<Placement>> place_objects(Scenario const& scenario, World const& world, std::uint32_t seed);

/// Distance between neighbours in the lattice in which a formation places the objects of this entry, mm.
float lattice_spacing_mm(Scenario const& scenario, ObjectConfig const& object);

}  // namespace pogosim
