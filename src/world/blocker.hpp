// Bodies that do not let something pass: messages (`blocks_infrared`), light (`blocks_light`).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/polygon.hpp"
#include "world/world.hpp"

namespace pogosim {

/// A convex part of a rigid body, or the straight piece of a membrane between two neighbouring bodies.
struct Blocker {
    std::uint32_t body = 0;
    std::uint32_t next_body = kNone;  // of a membrane
    Polygon corners{};                // of a rigid body, in its own frame; of a disk: none
};

struct BlockerPose {
    Vec2 position_mm;
    Vec2 axis;        // along the heading; of a piece of a membrane: from its middle to its end, mm
    float radius_mm;  // of the bounding disk

    friend bool operator==(BlockerPose const&, BlockerPose const&) = default;
};

/// Those of a world by the key of their bodies: pieces of membranes first.
std::vector<Blocker> blockers_of(World const& world, bool BodySpec::*blocks);

BlockerPose pose_of(World const& world, Blocker const& blocker);

}  // namespace pogosim
