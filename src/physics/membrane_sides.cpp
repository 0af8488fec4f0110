#include "physics/membrane_sides.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "base/grid.hpp"

namespace pogosim {

namespace {

bool is_part(Membrane const& membrane, std::size_t body) {
    return body >= membrane.body && body < std::size_t{membrane.body} + membrane.body_count;
}

/// Widest gap that the springs of a membrane leave between two of its bodies, mm.
float widest_gap_mm(World const& world, Membrane const& membrane) {
    float widest_mm = 0.0F;
    for (Joint const& joint : world.joints) {
        if (joint.max_stretch > 0.0F && is_part(membrane, joint.a)) {
            widest_mm = std::max(widest_mm, (1.0F + joint.max_stretch) * joint.length_mm -
                                                world.bodies.radius_mm[joint.a] - world.bodies.radius_mm[joint.b]);
        }
    }
    return widest_mm;
}

}  // namespace

MembraneSides::MembraneSides(World const& world) {
    for (Membrane const& membrane : world.membranes) {
        sides_.push_back({.membrane = membrane, .least_radius_mm = 0.5F * widest_gap_mm(world, membrane)});
    }
    look_again(world);
}

std::vector<std::uint32_t> const& MembraneSides::hold(World& world) {
    put_back_.clear();
    is_back_.clear();
    // Each iteration puts back at least one more body, so the loop ends: when all are back, none has crossed.
    while (any_body_crossed(world)) {
        is_back_.resize(world.bodies.size());
        for (Side const& side : sides_) {
            put_back_crossed(world.bodies, side);
        }
    }
    remember_poses(world.bodies);
    return put_back_;
}

/// Puts back the bodies that have crossed. If all of them are back already, the membrane has moved over them: then it
/// is put back itself.
void MembraneSides::put_back_crossed(Bodies& bodies, Side const& side) {
    crossed_.clear();
    std::ranges::set_symmetric_difference(side.was_inside, side.is_inside, std::back_inserter(crossed_));
    if (crossed_.empty()) {
        return;
    }
    bool const are_back = std::ranges::all_of(crossed_, [&](std::uint32_t i) { return is_back_[i]; });
    if (are_back) {
        crossed_.resize(side.membrane.body_count);
        std::iota(crossed_.begin(), crossed_.end(), side.membrane.body);
    }
    for (std::uint32_t const i : crossed_) {
        put_back(bodies, i);
    }
}

void MembraneSides::look_again(World const& world) {
    find_sides(world);
    for (Side& side : sides_) {
        side.was_inside = side.is_inside;
    }
    remember_poses(world.bodies);
}

bool MembraneSides::any_body_crossed(World const& world) {
    find_sides(world);
    return std::ranges::any_of(sides_, [](Side const& side) { return side.is_inside != side.was_inside; });
}

void MembraneSides::find_lines(World const& world) {
    for (Side& side : sides_) {
        auto const first = world.bodies.position_mm.begin() + side.membrane.body;
        side.line.assign(first, first + side.membrane.body_count);
        side.box = bounding_box(side.line);
        side.is_inside.clear();
    }
}

/// Tests a body only against membranes whose bounding boxes contain it.
void MembraneSides::find_sides(World const& world) {
    find_lines(world);
    float widest_mm = 0.0F;
    for (Side const& side : sides_) {
        widest_mm = std::max({widest_mm, side.box.size().x, side.box.size().y});
    }
    GridCells const cells(world.arena.bounds, widest_mm, world.bodies.size(), /*periodic=*/false);
    sides_in_cell_.resize(cells.size());
    for (std::vector<std::uint32_t>& sides : sides_in_cell_) {
        sides.clear();
    }
    for (std::uint32_t k = 0; k < sides_.size(); ++k) {
        Box const& box = sides_[k].box;
        float const half_mm = 0.5F * std::max(box.size().x, box.size().y);
        cells.any_near(0.5F * (box.min + box.max), half_mm, [&](std::size_t cell) {
            sides_in_cell_[cell].push_back(k);
            return false;
        });
    }
    for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
        Vec2 const place_mm = world.bodies.position_mm[i];
        for (std::uint32_t const k : sides_in_cell_[cells.cell_of(place_mm)]) {
            Side& side = sides_[k];
            if (side.box.contains(place_mm) && !is_part(side.membrane, i) &&
                world.bodies.radius_mm[i] >= side.least_radius_mm && contains(side.line, place_mm)) {
                side.is_inside.push_back(i);
            }
        }
    }
}

void MembraneSides::put_back(Bodies& bodies, std::uint32_t i) {
    if (is_back_[i]) {
        return;
    }
    is_back_[i] = true;
    bodies.position_mm[i] = poses_[i].position_mm;
    bodies.heading_rad[i] = poses_[i].heading_rad;
    bodies.heading_dir[i] = poses_[i].heading_dir;
    bodies.velocity_mm_s[i] = {};
    bodies.angular_velocity_rad_s[i] = 0.0F;
    put_back_.push_back(i);
}

void MembraneSides::remember_poses(Bodies const& bodies) {
    poses_.clear();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        poses_.push_back({bodies.position_mm[i], bodies.heading_rad[i], bodies.heading_dir[i]});
    }
}

}  // namespace pogosim
