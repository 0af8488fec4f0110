// Copies of the world for pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "light/lighting.hpp"
#include "render/snapshot.hpp"
#include "sim/link_finder.hpp"
#include "world/world.hpp"

namespace pogosim {

class SnapshotTaker {
public:
    /// All references outlive this.
    SnapshotTaker(World const& world, Lighting const& lighting);

    std::shared_ptr<Scenery const> const& scenery() const { return scenery_; }

    /// A copy of the world between two steps. Taking it changes nothing that a result depends on. Walls and membranes
    /// are included in the links; every sender counts at its present emitter power.
    Snapshot take(SnapshotParts parts);

    /// Trails take no more memory than this. Call it before follow_trails().
    void limit_trails(std::size_t most_bytes) { trails_ = Trails(most_bytes); }

    /// Adds the present positions to the trails. Call it after each step from which trails are wanted.
    void follow_trails();

private:
    std::shared_ptr<LightMap const> light();

    World const& world_;
    Lighting const& lighting_;
    std::shared_ptr<Scenery const> scenery_;
    std::shared_ptr<LightMap const> light_;  // the last one handed out
    Trails trails_;
    LinkFinder link_finder_;
    std::vector<float> range_mm_;  // of robots, at their present power
};

}  // namespace pogosim
