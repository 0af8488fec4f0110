#include "world/assert_world.hpp"

#include <cassert>
#include <cstddef>
#include <cstdint>

#ifndef NDEBUG
namespace pogosim {

namespace {

bool are_bodies(World const& world, std::uint32_t first, std::uint32_t count) {
    return std::size_t{first} + count <= world.bodies.size();
}

void assert_sizes(Bodies const& bodies) {
    assert(bodies.heading_rad.size() == bodies.size());
    assert(bodies.heading_dir.size() == bodies.size());
    assert(bodies.velocity_mm_s.size() == bodies.size());
    assert(bodies.angular_velocity_rad_s.size() == bodies.size());
    assert(bodies.start_mm.size() == bodies.size());
    assert(bodies.start_rad.size() == bodies.size());
    assert(bodies.radius_mm.size() == bodies.size());
    assert(bodies.shape.size() == bodies.size());
    assert(bodies.spec.size() == bodies.size());
}

void assert_robots(World const& world) {
    Robots const& robots = world.robots;
    assert(robots.category.size() == robots.size());
    assert(robots.body.size() == robots.size());
    assert(robots.led.size() == robots.size());
    assert(robots.command.size() == robots.size());
    assert(robots.stream.size() == robots.size());
    assert(world.mailboxes.robot_count() == robots.size());
    for (std::size_t i = 0; i < robots.size(); ++i) {
        assert(robots.category[i] < world.categories.size());
        assert(world.categories[robots.category[i]].spec.robot);
        assert(robots.body[i] == kNone || robots.body[i] < world.bodies.size());
        assert(robots.body[i] != kNone || world.spec_of(i).model.sends_along_outline);
        assert(robots.body[i] != kNone || !world.spec_of(i).model.has_motors());
    }
}

void assert_objects(World const& world) {
    for (Object const& object : world.objects) {
        assert(object.category < world.categories.size());
        assert(object.robot == kNone || object.robot < world.robots.size());
        assert((object.body == kNone) == (object.body_count == 0));
        assert(object.body == kNone || are_bodies(world, object.body, object.body_count));
        assert(object.robot == kNone || world.robots.body[object.robot] == object.body);
        assert(object.robot == kNone || world.robots.id[object.robot] == object.id);
    }
}

}  // namespace

void assert_structure(World const& world) {
    assert_sizes(world.bodies);
    assert_robots(world);
    assert_objects(world);
    for (Joint const& joint : world.joints) {
        assert(joint.a < world.bodies.size() && joint.b < world.bodies.size() && joint.a != joint.b);
    }
    for (Membrane const& membrane : world.membranes) {
        assert(membrane.body_count > 2 && are_bodies(world, membrane.body, membrane.body_count));
    }
    for (Outline const& outline : world.outlines) {
        assert(outline.robot < world.robots.size());
        assert(outline.body == kNone || are_bodies(world, outline.body, outline.body_count));
    }
    LightMap const& light = world.light;
    assert(light.columns > 0 && light.rows > 0);
    assert(light.level.size() == static_cast<std::size_t>(light.columns) * static_cast<std::size_t>(light.rows));
}

}  // namespace pogosim
#endif
