// The robots with four emitters, sorted by position into the cells of a grid, and when something last changed in each
// cell: if nothing has changed within a robot's range, it reaches the same robots as before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/grid.hpp"
#include "world/world.hpp"

namespace pogosim {

class NeighbourCells {
public:
    /// Takes the robots of a run. `cell_mm`: about the radius of the queries.
    void start(World const& world, float cell_mm);

    /// Sorts the robots by their present positions. A cell has changed if a robot in it has moved, turned, entered or
    /// left. Changes noted before the next update count as changes of this one.
    void update(World const& world);

    /// Notes a change of this robot on which its neighbours depend.
    void note_change(std::uint32_t robot);
    /// Notes a change within a disk, which may lie anywhere.
    void note_change_near(Vec2 centre, float radius_mm);
    /// Notes a change on which any robot may depend.
    void note_change_everywhere();

    /// Number of updates in which anything has changed: identifies a state.
    std::uint32_t changes() const { return changes_; }
    /// changes() before the last update.
    std::uint32_t changes_before() const { return changes_before_; }

    /// Whether nothing has changed since changes() had this value.
    bool is_unchanged(std::uint32_t since) const { return changes_ <= since; }

    /// The same for the cells that for_each_run_near() would visit.
    bool is_unchanged_near(std::uint32_t since, Vec2 centre, float radius_mm) const {
        return changes_ <= since ||
               (changed_everywhere_ <= since &&
                !cells_.any_near(centre, radius_mm, [&](std::size_t cell) { return changed_[cell] > since; }));
    }

    struct Neighbour {
        Vec2 position_mm;
        float radius_mm;
        std::uint32_t robot;
    };

    /// Calls visit(neighbours) with spans that together hold all robots whose centres are within the radius, and some
    /// others, always in the same order.
    template <class Visit>
    void for_each_run_near(Vec2 centre, float radius_mm, Visit const& visit) const {
        cells_.any_run_near(centre, radius_mm, [&](std::size_t first, std::size_t last) {
            visit(std::span(sorted_).subspan(start_[first], start_[last + 1] - start_[first]));
            return false;
        });
    }

    std::size_t size() const { return disks_.size(); }
    std::uint32_t robot(std::size_t disk) const { return disks_[disk].robot; }
    Vec2 position_mm(std::size_t disk) const { return poses_[disk].position_mm; }

private:
    /// Constants of a run.
    struct Disk {
        std::uint32_t robot;
        std::uint32_t body;
        float radius_mm;
    };

    struct Pose {
        Vec2 position_mm;
        Vec2 heading_dir;

        friend bool operator==(Pose const&, Pose const&) = default;
    };

    /// Where a disk is in the grid.
    struct Slot {
        std::uint32_t cell;
        std::uint32_t place;  // in sorted_
    };

    void sort();
    void mark(std::size_t cell);

    GridCells cells_;
    std::vector<Disk> disks_;  // in the order of the robots
    std::vector<Pose> poses_;  // at the last update
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> start_;    // of each cell in sorted_, and the end
    std::vector<Neighbour> sorted_;       // by cell, then in the order of the robots
    std::vector<std::uint32_t> changed_;  // by cell: changes() at its last change
    std::uint32_t changed_everywhere_ = 0;
    std::uint32_t changes_ = 0;
    std::uint32_t changes_before_ = 0;
};

}  // namespace pogosim
