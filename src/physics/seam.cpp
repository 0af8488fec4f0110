#include "physics/seam.hpp"

namespace pogosim {

void Seam::shift(World& world, Object const& object, Vec2 way_mm) {
    if (way_mm == Vec2{}) {
        return;
    }
    for (std::uint32_t i = object.body; i < object.body + object.body_count; ++i) {
        world.bodies.position_mm[i] = world.bodies.position_mm[i] + way_mm;
        moved_.push_back(i);
    }
}

/// Wraps a membrane with the rigid objects in it, and takes these off the list of those still to wrap.
void Seam::wrap_with_contents(World& world, Object const& membrane) {
    auto const first = world.bodies.position_mm.begin() + membrane.body;
    line_.assign(first, first + membrane.body_count);
    Box const box = bounding_box(line_);
    Vec2 const way = offset_into_bounds(world, centre_mm(world, membrane));
    shift(world, membrane, way);
    std::erase_if(rest_, [&](Object const* object) {
        Vec2 const place = world.bodies.position_mm[object->body];
        bool const is_inside = box.contains(place) && contains(line_, place);
        if (is_inside) {
            shift(world, *object, way);
        }
        return is_inside;
    });
}

std::vector<std::uint32_t> const& Seam::wrap_objects(World& world) {
    moved_.clear();
    rest_.clear();
    for (Object const& object : world.objects) {
        if (object.body_count == 1 && !world.bodies.spec[object.body].fixed) {
            rest_.push_back(&object);
        }
    }
    for (Object const& object : world.objects) {
        if (object.body_count > 1) {
            wrap_with_contents(world, object);
        }
    }
    for (Object const* object : rest_) {
        shift(world, *object, offset_into_bounds(world, centre_mm(world, *object)));
    }
    return moved_;
}

}  // namespace pogosim
