#include "sim/standing_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "sim/make_membrane.hpp"

namespace pogosim {

std::vector<Obstacle> obstacles_of(ObjectConfig const& object, Placement const& pose) {
    std::string const name = fmt::format("'{}'", object.category);
    if (!object.spec.membrane) {
        return solid_obstacles(name, object.spec.shape, pose.position_mm, pose.heading_rad);
    }
    return {{.name = name,
             .line = membrane_line(object.spec, pose),
             .half_thickness_mm = half_thickness_mm(*object.spec.membrane),
             .solid = false}};
}

void add_standing(ObjectConfig const& object, std::vector<Placement> const& poses,
                  std::vector<StandingObject>& objects) {
    for (Placement const& pose : poses) {
        objects.push_back({&object, pose.position_mm, outer_radius_mm(object.spec), obstacles_of(object, pose)});
    }
}

float half_thickness_mm(ObjectSpec const& spec) {
    return spec.membrane ? half_thickness_mm(*spec.membrane) : inner_radius(spec.shape);
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
    float depth = 0.0F;
    for (Obstacle const& a : one.obstacles) {
        for (Obstacle const& b : other.obstacles) {
            depth = std::max(depth, depth_mm(a, b));
        }
    }
    return depth;
}

float OverlapFinder::depth_mm(Obstacle const& one, Obstacle const& other) const {
    float depth = overlap_mm(one, other);
    if (world_.periodic) {
        for (Obstacle const& image : images_across(world_.arena.bounds, other)) {
            depth = std::max(depth, overlap_mm(one, image));
        }
        for (Obstacle const& image : images_across(world_.arena.bounds, one)) {
            depth = std::max(depth, overlap_mm(image, other));
        }
    }
    return depth;
}

float OverlapFinder::into_walls_mm(std::size_t object) const {
    float depth = 0.0F;
    for (Obstacle const& part : objects_[object].obstacles) {
        depth = world_.periodic ? 0.0F : std::max(depth, overlap_mm(part, world_.arena));
    }
    return depth;
}

}  // namespace pogosim
