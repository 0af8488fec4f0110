// Shadows: what walls and bodies hide of the light of a lamp that stands at a point (`casts_shadows`).
//
// A cell of the light map is hidden when the straight line from the lamp to its centre has entered a body, or a wall,
// and left it again. So the cells in a body are lit by a lamp outside, and a body around the lamp hides nothing: it is
// the post that carries it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/polygon.hpp"
#include "world/blocker.hpp"
#include "world/world.hpp"

namespace pogosim {

class LightBlockers {
public:
    /// Takes the present poses of the bodies. Returns whether any that blocks light has moved since the last call.
    bool update(World const& world);

    /// Replaces `cells` by those of world.light that walls hide from a lamp at `source_mm`, each once.
    void find_hidden_by_walls(World const& world, Vec2 source_mm, std::vector<std::uint32_t>& cells);

    /// Adds those that bodies hide from it and that are not among them.
    void add_hidden_by_bodies(World const& world, Vec2 source_mm, std::vector<std::uint32_t>& cells);

private:
    class Hidden;

    void start(World const& world);
    std::size_t end_of_body(std::size_t first) const;
    void add_shadow(std::size_t first, Vec2 offset_mm, Hidden& hidden);

    bool has_started_ = false;
    std::size_t body_count_ = 0;  // of the world
    std::vector<Blocker> blockers_;
    std::vector<BlockerPose> poses_;  // of the blockers
    std::vector<bool> has_sensors_;   // of all bodies: their own shadow leaves these in the light

    /// A cell whose line of sight crosses outlines several times, and its centre as seen from the lamp, mm.
    struct Touched {
        std::uint32_t cell;
        double x_mm;
        double y_mm;
    };

    /// Kept from call to call for its memory.
    struct Space {
        std::vector<std::uint8_t> is_hidden;   // of each cell; 0 between two calls
        std::vector<std::uint16_t> crossings;  // the same
        std::vector<Touched> touched;
        std::vector<std::uint32_t> once;  // cells with any crossing
        std::vector<Polygon> parts;       // of a body
    };
    Space space_;
};

}  // namespace pogosim
