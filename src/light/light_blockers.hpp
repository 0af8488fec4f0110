// Shadows: what walls and bodies hide of the light of a lamp that stands at a point (`casts_shadows`).
//
// A cell of the light map is hidden when the straight line from the lamp to its centre has entered a body, or a wall,
// and left it again. So the cells in a body are lit by a lamp outside, and a body around the lamp hides nothing: it is
// the post that carries it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

class LightBlockers {
public:
    /// Takes the present poses of the bodies. Returns whether any that blocks light has moved since the last call.
    bool update(World const& world);

    /// Replaces `cells` by those of world.light that are hidden from a lamp at `source_mm`, each once.
    void find_hidden(World const& world, Vec2 source_mm, std::vector<std::uint32_t>& cells);

private:
    /// A rigid body, or the straight piece of a membrane between two neighbouring bodies.
    struct Blocker {
        std::uint32_t body = 0;
        std::uint32_t next_body = kNone;  // of a membrane
        bool has_sensors = false;         // its own shadow leaves them in the light
        Polygon corners{};                // of a rigid body, in its own frame; of a disk: none
    };

    struct Pose {
        Vec2 position_mm;
        Vec2 axis;        // along the heading; of a piece of a membrane: from its middle to its end, mm
        float radius_mm;  // of the bounding disk

        friend bool operator==(Pose const&, Pose const&) = default;
    };

    class Hidden;

    void start(World const& world);
    static Pose pose_of(World const& world, Blocker const& blocker);
    static void add_shadow(Blocker const& blocker, Pose const& pose, Vec2 offset_mm, Hidden& hidden);

    bool has_started_ = false;
    std::size_t body_count_ = 0;  // of the world
    std::vector<Blocker> blockers_;
    std::vector<Pose> poses_;  // of the blockers

    // Space for find_hidden(), 0 for each cell between two calls.
    std::vector<std::uint8_t> is_hidden_;
    std::vector<std::uint16_t> crossings_;
};

}  // namespace pogosim
