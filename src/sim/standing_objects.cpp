#include "sim/standing_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "sim/make_membrane.hpp"

namespace pogosim {

std::vector<Obstacle> obstacles_of(ObjectConfig const& object, std::vector<Placement> const& poses) {
    std::vector<Obstacle> obstacles;
    std::string const name = fmt::format("'{}'", object.category);
    for (Placement const& pose : poses) {
        if (object.spec.membrane) {
            obstacles.push_back({.name = name,
                                 .line = membrane_line(object.spec, pose),
                                 .half_thickness_mm = half_thickness_mm(*object.spec.membrane),
                                 .solid = false});
        } else {
            obstacles.push_back(solid_obstacle(name, object.spec.shape, pose.position_mm, pose.heading_rad));
        }
    }
    return obstacles;
}

void add_standing(ObjectConfig const& object, std::vector<Placement> const& poses,
                  std::vector<StandingObject>& objects) {
    std::vector<Obstacle> const obstacles = obstacles_of(object, poses);
    float const radius_mm = outer_radius_mm(object.spec);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        objects.push_back({&object, poses[i].position_mm, radius_mm, obstacles[i]});
    }
}

float half_thickness_mm(ObjectSpec const& spec) {
    if (spec.membrane) {
        return half_thickness_mm(*spec.membrane);
    }
    switch (spec.shape.kind) {
        case ShapeKind::rectangle:
            return 0.5F * std::min(spec.shape.width_mm, spec.shape.height_mm);
        case ShapeKind::triangle:
            return 0.5F * bounding_radius(spec.shape);
        default:
            return bounding_radius(spec.shape);
    }
}

OverlapFinder::OverlapFinder(std::vector<StandingObject> const& objects, World const& world)
    : objects_(objects), world_(world) {
    std::vector<Vec2> positions_mm;
    for (StandingObject const& object : objects) {
        positions_mm.push_back(object.position_mm);
        largest_mm_ = std::max(largest_mm_, object.radius_mm);
    }
    grid_.build(positions_mm, world.arena.bounds, std::max(2.0F * largest_mm_, 1.0F), world.periodic);
}

std::vector<Overlap> OverlapFinder::with_earlier(std::size_t object) const {
    StandingObject const& own = objects_[object];
    std::vector<std::size_t> near;
    grid_.for_each_near(own.position_mm, own.radius_mm + largest_mm_, [&](std::uint32_t other, Vec2 place_mm) {
        float const apart_mm = length(minimum_image(world_, own.position_mm, place_mm));
        if (other < object && apart_mm <= own.radius_mm + objects_[other].radius_mm) {
            near.push_back(other);
        }
    });
    std::ranges::sort(near);
    std::vector<Overlap> found;
    for (std::size_t const other : near) {
        if (float const depth = depth_mm(own, objects_[other]); depth > 0.0F) {
            found.push_back({other, depth});
        }
    }
    return found;
}

float OverlapFinder::depth_mm(StandingObject const& one, StandingObject const& other) const {
    float depth = overlap_mm(one.obstacle, other.obstacle);
    if (world_.periodic) {
        for (Obstacle const& image : images_across(world_.arena.bounds, other.obstacle)) {
            depth = std::max(depth, overlap_mm(one.obstacle, image));
        }
        for (Obstacle const& image : images_across(world_.arena.bounds, one.obstacle)) {
            depth = std::max(depth, overlap_mm(image, other.obstacle));
        }
    }
    return depth;
}

float OverlapFinder::into_walls_mm(std::size_t object) const {
    return world_.periodic ? 0.0F : overlap_mm(objects_[object].obstacle, world_.arena);
}

}  // namespace pogosim
