#include "physics/box2d_shapes.hpp"

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/exact_math.hpp"
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

/// Area of a convex polygon around its centroid, and the square of its radius of gyration.
std::pair<float, float> area_and_gyration2(b2PolygonShape const& polygon) {
    float area = 0.0F;
    float moment = 0.0F;
    for (int32 i = 0; i < polygon.m_count; ++i) {
        b2Vec2 const a = polygon.m_vertices[i];
        b2Vec2 const b = polygon.m_vertices[(i + 1) % polygon.m_count];
        float const triangle = 0.5F * b2Cross(a, b);
        area += triangle;
        moment += triangle * (b2Dot(a, a) + b2Dot(a, b) + b2Dot(b, b)) / 6.0F;
    }
    return {area, area > 0.0F ? moment / area : 0.0F};
}

/// Corners clockwise on the screen around the centroid, convex. By hand, since b2PolygonShape::Set() joins corners that
/// lie close together.
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
    float const density = std::exchange(fixture.density, 0.0F);
    body.CreateFixture(&fixture);
    auto const [area, gyration2] = area_and_gyration2(polygon);
    set_mass(body, density * area, gyration2);
}

void add_disk(b2Body& body, float radius_mm, b2FixtureDef fixture) {
    float const radius = radius_mm / kMmPerUnit;
    b2CircleShape disk;
    disk.m_radius = radius + kSkin;
    fixture.shape = &disk;
    float const density = std::exchange(fixture.density, 0.0F);
    body.CreateFixture(&fixture);
    // The skin weighs nothing.
    float const mass = density * std::numbers::pi_v<float> * radius * radius;
    set_mass(body, mass, 0.5F * radius * radius);
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

void add_shape(b2Body& body, Shape const& shape, b2FixtureDef const& fixture) {
    if (shape.kind == ShapeKind::rectangle || shape.kind == ShapeKind::triangle) {
        add_polygon(body, outline(shape), fixture);
    } else {
        add_disk(body, bounding_radius(shape), fixture);
    }
}

}  // namespace pogosim
