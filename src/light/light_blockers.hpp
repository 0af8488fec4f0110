// Shadows: what walls and bodies hide of the light of a lamp that stands at a point (`casts_shadows`).
//
// A cell of the light map is hidden when the straight line from the lamp to its centre has entered a body, or a wall,
// and left it again. So the cells in a body are lit by a lamp outside, and a body around the lamp hides nothing: it is
// the post that carries it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/blocker.hpp"
#include "world/world.hpp"

namespace pogosim {

class LightBlockers {
public:
    /// Takes the present poses of the bodies. Returns whether any that blocks light has moved since the last call.
    bool update(World const& world);

    /// Replaces `cells` by those of world.light that are hidden from a lamp at `source_mm`, each once.
    void find_hidden(World const& world, Vec2 source_mm, std::vector<std::uint32_t>& cells);

private:
    class Hidden;

    void start(World const& world);
    std::size_t end_of_body(std::size_t first) const;
    void add_shadow(std::size_t first, Vec2 offset_mm, Hidden& hidden) const;

    bool has_started_ = false;
    std::size_t body_count_ = 0;  // of the world
    std::vector<Blocker> blockers_;
    std::vector<BlockerPose> poses_;  // of the blockers
    std::vector<bool> has_sensors_;   // of all bodies: their own shadow leaves these in the light

    // Space for find_hidden(), 0 for each cell between two calls.
    std::vector<std::uint8_t> is_hidden_;
    std::vector<std::uint16_t> crossings_;
};

}  // namespace pogosim
