// The edges of walls that disks can touch in the coming steps: a Verlet list like that of neighbour_list.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/wall_index.hpp"
#include "physics/position_correction.hpp"
#include "physics/wall_side.hpp"
#include "world/world.hpp"

namespace pogosim {

struct NeighbourWall {
    std::uint32_t body;
    std::uint32_t edge;  // see WallNeighbourList::side()
};

class WallNeighbourList {
public:
    WallNeighbourList(World const& world, WallIndex const& walls);

    /// Finds the edges that are less than `skin_mm` from movable disks. `places`: those of the bodies now.
    void build(World const& world, PositionCorrection const& places, float skin_mm);

    std::span<NeighbourWall const> walls() const { return near_; }
    WallSide const& side(std::uint32_t edge) const { return (*sides_)[edge]; }

    /// All of them, which stay as they are.
    std::shared_ptr<WallSides const> const& sides() const { return sides_; }

    /// What later steps depend on, see state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.near_);
    }

private:
    std::shared_ptr<WallSides const> sides_;
    std::vector<NeighbourWall> near_;
    std::vector<std::uint32_t> found_;  // of one body
};

}  // namespace pogosim
