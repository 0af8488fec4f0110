#include "comms/neighbour_cells.hpp"

#include <algorithm>
#include <numeric>

namespace pogosim {

void NeighbourCells::start(World const& world, float cell_mm) {
    disks_.clear();
    poses_.clear();
    slots_.clear();
    for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
        if (!world.spec_of(i).model.sends_along_outline) {
            std::uint32_t const body = world.robots.body[i];
            disks_.push_back({.robot = i, .body = body, .radius_mm = world.bodies.radius_mm[body]});
            poses_.push_back({world.bodies.position_mm[body], world.bodies.heading_dir[body]});
        }
    }
    cells_ = GridCells(world.arena.bounds, std::max(cell_mm, 1.0F), disks_.size(), world.periodic);
    for (Pose const& pose : poses_) {
        slots_.push_back({.cell = static_cast<std::uint32_t>(cells_.cell_of(pose.position_mm)), .place = 0});
    }
    sorted_.resize(disks_.size());
    changed_.assign(cells_.size(), 0);
    sort();
    changes_before_ = changes_;
    note_change_everywhere();
}

void NeighbourCells::sort() {
    // Counting sort by cell.
    start_.assign(cells_.size() + 1, 0);
    for (Slot const& slot : slots_) {
        ++start_[slot.cell];
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    // Filling from the back moves each cell's end to its start.
    for (std::size_t i = disks_.size(); i-- > 0;) {
        std::uint32_t const place = --start_[slots_[i].cell];
        slots_[i].place = place;
        sorted_[place] = {poses_[i].position_mm, disks_[i].radius_mm, disks_[i].robot};
    }
}

void NeighbourCells::update(World const& world) {
    changes_before_ = changes_;
    Bodies const& bodies = world.bodies;
    bool is_sorted = true;
    for (std::size_t i = 0; i < disks_.size(); ++i) {
        std::uint32_t const body = disks_[i].body;
        Pose const pose{bodies.position_mm[body], bodies.heading_dir[body]};
        if (pose == poses_[i]) {
            continue;
        }
        poses_[i] = pose;
        Slot& slot = slots_[i];
        auto const cell = static_cast<std::uint32_t>(cells_.cell_of(pose.position_mm));
        mark(slot.cell);
        if (cell == slot.cell) {
            sorted_[slot.place].position_mm = pose.position_mm;
        } else {
            slot.cell = cell;
            mark(cell);
            is_sorted = false;
        }
    }
    if (!is_sorted) {
        sort();
    }
}

void NeighbourCells::mark(std::size_t cell) {
    changes_ = changes_before_ + 1;
    changed_[cell] = changes_;
}

void NeighbourCells::note_change(std::uint32_t robot) {
    auto const disk = std::ranges::lower_bound(disks_, robot, {}, &Disk::robot);
    if (disk != disks_.end() && disk->robot == robot) {
        mark(slots_[static_cast<std::size_t>(disk - disks_.begin())].cell);
    } else {
        note_change_everywhere();  // a wall or a membrane
    }
}

void NeighbourCells::note_change_near(Vec2 centre, float radius_mm) {
    cells_.any_near(centre, radius_mm, [&](std::size_t cell) {
        mark(cell);
        return false;
    });
}

void NeighbourCells::note_change_everywhere() {
    changes_ = changes_before_ + 1;
    changed_everywhere_ = changes_;
}

}  // namespace pogosim
