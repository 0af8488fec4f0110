#include "comms/infrared_blockers.hpp"

#include <algorithm>
#include <cmath>

namespace pogosim {

namespace {

bool passes_disk(Vec2 from, Vec2 to, Vec2 centre, float radius) {
    return squared_length(nearest_on_segment(from, to, centre) - centre) < radius * radius;
}

/// Whether the line between `from` and `to` crosses the edge between `a` and `b`. A point on a line counts as on its
/// left, so that a line through a corner of a polygon crosses one of the two edges that meet there.
bool crosses_edge(Vec2 from, Vec2 to, Vec2 a, Vec2 b) {
    auto const is_right = [](Vec2 start, Vec2 end, Vec2 point) { return cross(end - start, point - start) > 0.0F; };
    return is_right(from, to, a) != is_right(from, to, b) && is_right(a, b, from) != is_right(a, b, to);
}

/// Whole widths of the arena to either side within which the images of a body count.
int images_beside(float reach_mm, float width_mm) {
    return static_cast<int>((reach_mm + 0.5F * width_mm) / width_mm);
}

}  // namespace

void NearbyBlockers::clear() {
    disks_.clear();
    edges_.clear();
}

bool NearbyBlockers::block(Vec2 from_mm, Vec2 to_mm) const {
    return std::ranges::any_of(
               disks_, [&](Disk const& disk) { return passes_disk(from_mm, to_mm, disk.centre_mm, disk.radius_mm); }) ||
           std::ranges::any_of(
               edges_, [&](Edge const& edge) { return crosses_edge(from_mm, to_mm, edge.from_mm, edge.to_mm); });
}

void InfraredBlockers::start(World const& world) {
    walls_.reset();
    if (world.walls_block_infrared && !world.periodic) {
        walls_.emplace(world.arena);
    }
    blockers_ = blockers_of(world, &BodySpec::blocks_infrared);
    poses_.clear();
    for (Blocker const& blocker : blockers_) {
        poses_.push_back(pose_of(world, blocker));
    }
    sort(world);
}

void InfraredBlockers::sort(World const& world) {
    positions_mm_.clear();
    largest_radius_mm_ = 0.0F;
    for (BlockerPose const& pose : poses_) {
        positions_mm_.push_back(pose.position_mm);
        largest_radius_mm_ = std::max(largest_radius_mm_, pose.radius_mm);
    }
    if (!poses_.empty()) {
        float const cell_mm = std::max(2.0F * largest_radius_mm_, 1.0F);
        grid_.build(positions_mm_, world.arena.bounds, cell_mm, world.periodic);
    }
}

void InfraredBlockers::update(World const& world, NeighbourCells& cells) {
    bool has_moved = false;
    for (std::size_t i = 0; i < blockers_.size(); ++i) {
        BlockerPose const pose = pose_of(world, blockers_[i]);
        if (pose == poses_[i]) {
            continue;
        }
        cells.note_change_near(poses_[i].position_mm, poses_[i].radius_mm);
        cells.note_change_near(pose.position_mm, pose.radius_mm);
        poses_[i] = pose;
        has_moved = true;
    }
    if (has_moved) {
        sort(world);
    }
}

void InfraredBlockers::add(std::uint32_t index, Vec2 offset_mm, NearbyBlockers& found) const {
    Blocker const& blocker = blockers_[index];
    BlockerPose const& pose = poses_[index];
    if (blocker.next_body != kNone) {
        found.add_edge(offset_mm - pose.axis, offset_mm + pose.axis);
        return;
    }
    if (blocker.corners.empty()) {
        found.add_disk(offset_mm, pose.radius_mm);
        return;
    }
    Vec2 from = offset_mm + rotate(blocker.corners.back(), pose.axis);
    for (Vec2 const corner : blocker.corners) {
        Vec2 const to = offset_mm + rotate(corner, pose.axis);
        found.add_edge(from, to);
        from = to;
    }
}

void InfraredBlockers::find_near(World const& world, Vec2 centre_mm, float radius_mm, NearbyBlockers& found) const {
    found.clear();
    if (walls_) {
        walls_->for_each_near(centre_mm, radius_mm, [&](WallEdge const& edge) {
            found.add_edge(edge.from - centre_mm, edge.to - centre_mm);
        });
    }
    if (blockers_.empty()) {
        return;
    }
    Vec2 const size = world.arena.bounds.size();
    float const lines_mm = world.periodic ? std::min(radius_mm, 0.5F * length(size)) : radius_mm;
    grid_.for_each_near(centre_mm, lines_mm + largest_radius_mm_, [&](std::uint32_t i, Vec2 position_mm) {
        Vec2 const nearest = minimum_image(world, centre_mm, position_mm);
        float const reach_mm = lines_mm + poses_[i].radius_mm;
        // One image, unless a body or the range is about as large as a periodic arena.
        int const columns = world.periodic ? images_beside(std::min(reach_mm, 2.0F * length(size)), size.x) : 0;
        int const rows = world.periodic ? images_beside(std::min(reach_mm, 2.0F * length(size)), size.y) : 0;
        for (int column = -columns; column <= columns; ++column) {
            for (int row = -rows; row <= rows; ++row) {
                Vec2 const offset =
                    nearest + Vec2{static_cast<float>(column) * size.x, static_cast<float>(row) * size.y};
                if (squared_length(offset) <= reach_mm * reach_mm) {
                    add(i, offset, found);
                }
            }
        }
    });
}

}  // namespace pogosim
