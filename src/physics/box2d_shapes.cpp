#include "physics/box2d_shapes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/exact_math.hpp"
#include "physics/body_mass.hpp"
#include "physics/box2d_units.hpp"

namespace pogosim {

namespace {

// Box2D lets shapes sink into each other by its tolerance, half of it on either side. Shapes are larger by that half,
// so that bodies come to rest at their true distance. A chain has a skin of b2_polygonRadius, 1 mm, which Box2D gives
// every copy of it: bodies rest 0.5 to 1.25 mm before walls.
constexpr float kSkin = b2_linearSlop / 2.0F;
// Corners of a wall that lie closer together than this are joined; Box2D's tolerance is 0.5 mm.
constexpr float kShortestEdgeMm = 1.0F;
// Box2D treats a body of mass 0, to which the mass of a tiny one is rounded, as a body of mass 1.
constexpr float kLightest = 1e-15F;

std::vector<b2Vec2> wall_corners(Polygon const& polygon, bool outer) {
    std::vector<b2Vec2> corners;
    Vec2 last = polygon.back();
    for (Vec2 const corner : polygon) {
        if (length(corner - last) >= kShortestEdgeMm) {
            corners.push_back(to_box2d(corner));
            last = corner;
        }
    }
    if (corners.size() < 3) {
        throw ConfigError("the arena is too small to build walls: its corners lie less than 1 mm apart; enlarge it");
    }
    // Chains push to one side: inwards for the outer wall, outwards for holes.
    bool const clockwise_on_screen = signed_area(polygon) > 0.0;
    if (clockwise_on_screen == outer) {
        std::reverse(corners.begin(), corners.end());
    }
    return corners;
}

/// Corners clockwise on the screen, convex. By hand, since b2PolygonShape::Set() joins corners that lie close together.
void add_polygon(b2Body& body, Polygon const& corners_mm, b2FixtureDef fixture) {
    b2PolygonShape polygon;
    polygon.m_centroid = b2Vec2_zero;
    polygon.m_count = static_cast<int32>(corners_mm.size());
    for (std::size_t i = 0; i < corners_mm.size(); ++i) {
        Vec2 const edge = corners_mm[(i + 1) % corners_mm.size()] - corners_mm[i];
        polygon.m_vertices[i] = to_box2d(corners_mm[i]);
        float const edge_mm = exact::hypot(edge.x, edge.y);  // the square of a tiny length would be 0
        polygon.m_normals[i] = {edge.y / edge_mm, -edge.x / edge_mm};
    }
    polygon.m_radius = kSkin;
    fixture.shape = &polygon;
    body.CreateFixture(&fixture);
}

void add_disk(b2Body& body, Vec2 centre_mm, float radius_mm, b2FixtureDef fixture) {
    b2CircleShape disk;
    disk.m_p = to_box2d(centre_mm);
    disk.m_radius = radius_mm / kMmPerUnit + kSkin;
    fixture.shape = &disk;
    body.CreateFixture(&fixture);
}

/// The rectangle outside a side.
Polygon strip(Vec2 from_mm, Vec2 to_mm, float width_mm) {
    Vec2 const way = to_mm - from_mm;
    float const length_mm = exact::hypot(way.x, way.y);
    Vec2 const out_mm = (width_mm / length_mm) * Vec2{way.y, -way.x};
    return {from_mm + out_mm, to_mm + out_mm, to_mm, from_mm};
}

/// Box2D has no rounded polygons that roll over their corners, so one is put together: its core, a strip along each
/// side and a disk at each corner.
void add_part(b2Body& body, RoundedPolygon const& part, b2FixtureDef const& fixture) {
    Polygon const& corners = part.corners_mm;
    if (corners.size() > 2) {
        add_polygon(body, corners, fixture);
    }
    for (std::size_t i = 0; i < corners.size() && part.radius_mm > 0.0F; ++i) {
        add_disk(body, corners[i], part.radius_mm, fixture);
        if (corners.size() > 1) {
            add_polygon(body, strip(corners[i], corners[(i + 1) % corners.size()], part.radius_mm), fixture);
        }
    }
}

}  // namespace

void add_wall(b2Body& body, Polygon const& polygon, bool outer, b2FixtureDef fixture) {
    std::vector<b2Vec2> const corners = wall_corners(polygon, outer);
    b2ChainShape chain;
    chain.CreateLoop(corners.data(), static_cast<int32>(corners.size()));
    fixture.shape = &chain;
    body.CreateFixture(&fixture);
}

void set_mass(b2Body& body, float mass, float gyration2) {
    float const at_least = std::max(mass, kLightest);
    b2MassData const data{.mass = at_least, .center = b2Vec2_zero, .I = at_least * gyration2};
    body.SetMassData(&data);
}

void add_shape(b2Body& body, Shape const& shape, b2FixtureDef fixture) {
    float const density = std::exchange(fixture.density, 0.0F);  // no skin weighs anything
    for (RoundedPolygon const& part : convex_parts(shape)) {
        add_part(body, part, fixture);
    }
    constexpr float mm2 = kMmPerUnit * kMmPerUnit;
    ShapeMass const mass = mass_of(shape);
    set_mass(body, density * mass.area_mm2 / mm2, mass.gyration_mm2 / mm2);
}

}  // namespace pogosim
