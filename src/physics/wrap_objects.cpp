#include "physics/wrap_objects.hpp"

#include <cmath>

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

/// What has to be added to come back into the bounds.
Vec2 way_back(Box const& bounds, Vec2 point) {
    Vec2 const size = bounds.size();
    return {-size.x * std::floor((point.x - bounds.min.x) / size.x),
            -size.y * std::floor((point.y - bounds.min.y) / size.y)};
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

/// Wraps a ring with the rigid objects in it, and takes these off the list of those still to wrap.
void wrap_with_contents(Box const& bounds, EngineBodies const& bodies, Object const& ring,
                        std::vector<Object const*>& rest) {
    Polygon line;
    for (std::uint32_t k = 0; k < ring.body_count; ++k) {
        line.push_back(from_box2d(bodies[ring.body + k]->GetPosition()));
    }
    Box const box = bounding_box(line);
    Vec2 const way = way_back(bounds, centre_of(bodies, ring));
    shift(bodies, ring, way);
    std::erase_if(rest, [&](Object const* object) {
        Vec2 const place = from_box2d(bodies[object->body]->GetPosition());
        bool const is_near = place.x > box.min.x && place.x < box.max.x && place.y > box.min.y && place.y < box.max.y;
        bool const is_inside = is_near && contains(line, place);
        if (is_inside) {
            shift(bodies, *object, way);
        }
        return is_inside;
    });
}

}  // namespace

void wrap_objects(World const& world, EngineBodies const& bodies) {
    Box const& bounds = world.arena.bounds;
    std::vector<Object const*> rigid;
    for (Object const& object : world.objects) {
        if (object.body_count == 1) {
            rigid.push_back(&object);
        }
    }
    for (Object const& object : world.objects) {
        if (object.body_count > 1) {
            wrap_with_contents(bounds, bodies, object, rigid);
        }
    }
    for (Object const* object : rigid) {
        shift(bodies, *object, way_back(bounds, centre_of(bodies, *object)));
    }
}

}  // namespace pogosim
