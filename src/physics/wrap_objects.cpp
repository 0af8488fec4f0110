#include "physics/wrap_objects.hpp"

#include <cstdint>

#include "geometry/polygon.hpp"

namespace pogosim {

namespace {

using EngineBodies = std::vector<b2Body*>;

Vec2 centre_of(EngineBodies const& bodies, Object const& object) {
    Vec2 sum;
    for (std::uint32_t k = 0; k < object.body_count; ++k) {
        sum = sum + from_box2d(bodies[object.body + k]->GetPosition());
    }
    return (1.0F / static_cast<float>(object.body_count)) * sum;
}

void shift(EngineBodies const& bodies, Object const& object, Vec2 way_mm) {
    if (way_mm == Vec2{}) {
        return;
    }
    for (std::uint32_t k = 0; k < object.body_count; ++k) {
        b2Body& body = *bodies[object.body + k];
        body.SetTransform(body.GetPosition() + to_box2d(way_mm), body.GetAngle());
    }
}

/// Wraps a membrane with the rigid objects in it, and takes these off the list of those still to wrap.
void wrap_with_contents(World const& world, EngineBodies const& bodies, Object const& membrane,
                        std::vector<Object const*>& rest) {
    Polygon line;
    for (std::uint32_t k = 0; k < membrane.body_count; ++k) {
        line.push_back(from_box2d(bodies[membrane.body + k]->GetPosition()));
    }
    Box const box = bounding_box(line);
    Vec2 const way = offset_into_bounds(world, centre_of(bodies, membrane));
    shift(bodies, membrane, way);
    std::erase_if(rest, [&](Object const* object) {
        Vec2 const place = from_box2d(bodies[object->body]->GetPosition());
        bool const is_inside = box.contains(place) && contains(line, place);
        if (is_inside) {
            shift(bodies, *object, way);
        }
        return is_inside;
    });
}

}  // namespace

void wrap_objects(World const& world, EngineBodies const& bodies) {
    std::vector<Object const*> rigid;
    for (Object const& object : world.objects) {
        if (object.body_count == 1 && !world.bodies.spec[object.body].fixed) {
            rigid.push_back(&object);
        }
    }
    for (Object const& object : world.objects) {
        if (object.body_count > 1) {
            wrap_with_contents(world, bodies, object, rigid);
        }
    }
    for (Object const* object : rigid) {
        shift(bodies, *object, offset_into_bounds(world, centre_of(bodies, *object)));
    }
}

}  // namespace pogosim
