// What infrared does not pass: walls of the arena and bodies that block it (`walls_block_infrared`, `blocks_infrared`).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/grid.hpp"
#include "comms/neighbour_cells.hpp"
#include "geometry/wall_index.hpp"
#include "world/blocker.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Blockers around a point, relative to it.
class NearbyBlockers {
public:
    void clear();
    void add_disk(Vec2 centre_mm, float radius_mm) { disks_.push_back({centre_mm, radius_mm}); }
    void add_edge(Vec2 from_mm, Vec2 to_mm) { edges_.push_back({from_mm, to_mm}); }

    bool empty() const { return disks_.empty() && edges_.empty(); }

    /// Whether the straight line between two points passes through a disk or crosses an edge.
    bool block(Vec2 from_mm, Vec2 to_mm) const;

private:
    struct Disk {
        Vec2 centre_mm;
        float radius_mm;
    };
    struct Edge {
        Vec2 from_mm;
        Vec2 to_mm;
    };

    std::vector<Disk> disks_;
    std::vector<Edge> edges_;
};

class InfraredBlockers {
public:
    /// Takes the blockers of a run.
    void start(World const& world);

    /// Takes their present poses. Notes a change in the cells from which one that has moved may be seen.
    void update(World const& world, NeighbourCells& cells);

    bool empty() const { return !walls_ && blockers_.empty(); }

    /// Replaces `found` by the blockers within `radius_mm` of the centre, and some others. In a periodic world, lines
    /// from the centre are at most half of the arena's diagonal long, whatever the radius.
    void find_near(World const& world, Vec2 centre_mm, float radius_mm, NearbyBlockers& found) const;

private:
    void add(std::uint32_t blocker, Vec2 offset_mm, NearbyBlockers& found) const;
    void sort(World const& world);

    std::optional<WallIndex> walls_;
    std::vector<Blocker> blockers_;
    std::vector<BlockerPose> poses_;  // of the blockers
    std::vector<Vec2> positions_mm_;  // the same, for the grid
    float largest_radius_mm_ = 0.0F;
    UniformGrid grid_;
};

}  // namespace pogosim
