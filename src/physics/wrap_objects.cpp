#include "physics/wrap_objects.hpp"

#include "geometry/polygon.hpp"

namespace pogosim {

namespace {

void shift(World& world, Object const& object, Vec2 way_mm, std::vector<std::uint32_t>& moved) {
    if (way_mm == Vec2{}) {
        return;
    }
    for (std::uint32_t i = object.body; i < object.body + object.body_count; ++i) {
        world.bodies.position_mm[i] = world.bodies.position_mm[i] + way_mm;
        moved.push_back(i);
    }
}

/// Wraps a membrane with the rigid objects in it, and takes these off the list of those still to wrap.
void wrap_with_contents(World& world, Object const& membrane, std::vector<Object const*>& rest,
                        std::vector<std::uint32_t>& moved) {
    auto const first = world.bodies.position_mm.begin() + membrane.body;
    Polygon const line(first, first + membrane.body_count);
    Box const box = bounding_box(line);
    Vec2 const way = offset_into_bounds(world, centre_mm(world, membrane));
    shift(world, membrane, way, moved);
    std::erase_if(rest, [&](Object const* object) {
        Vec2 const place = world.bodies.position_mm[object->body];
        bool const is_inside = box.contains(place) && contains(line, place);
        if (is_inside) {
            shift(world, *object, way, moved);
        }
        return is_inside;
    });
}

}  // namespace

std::vector<std::uint32_t> wrap_objects(World& world) {
    std::vector<std::uint32_t> moved;
    std::vector<Object const*> rigid;
    for (Object const& object : world.objects) {
        if (object.body_count == 1 && !world.bodies.spec[object.body].fixed) {
            rigid.push_back(&object);
        }
    }
    for (Object const& object : world.objects) {
        if (object.body_count > 1) {
            wrap_with_contents(world, object, rigid, moved);
        }
    }
    for (Object const* object : rigid) {
        shift(world, *object, offset_into_bounds(world, centre_mm(world, *object)), moved);
    }
    return moved;
}

}  // namespace pogosim
