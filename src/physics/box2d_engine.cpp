// Rigid bodies with Box2D 2.4.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "physics/box2d_units.hpp"
#include "physics/physics_engine.hpp"
#include "physics/ring_area.hpp"
#include "physics/ring_filter.hpp"
#include "physics/wrap_objects.hpp"

namespace pogosim {

namespace {

struct Iterations {
    int velocity;
    int position;
};
constexpr Iterations kForContacts{6, 3};
constexpr Iterations kForJoints{12, 6};  // a pull has to go round a ring
// Box2D sees a contact once it is there, so a pair overlaps by what it has approached since. Steps are cut into
// sub-steps in which no two robots at full speed approach by more than this, as long as that is not too many.
constexpr float kApproachMm = 1.0F;
constexpr int kMaxSubsteps = 8;
// Box2D lets shapes sink into each other by its tolerance, half of it on either side. Shapes are larger by that half,
// so that they rest at their true distance.
constexpr float kSkin = b2_linearSlop / 2.0F;
// Box2D calls slower collisions inelastic; its own limit of 1 unit/s is the full speed of a robot.
constexpr float kRestitutionThreshold = 0.05F;  // units/s
// Corners of a wall that lie closer together than this are joined; Box2D's tolerance is 0.5 mm.
constexpr float kShortestEdgeMm = 1.0F;
// A spring that swings more often than this per step cannot be followed and would shake; it is taken for one that
// swings just so often.
constexpr float kMostSwingsPerStep = 0.5F;
// The solver cannot hold back a heavy body by a chain of light ones. A robot with wheels weighs so many times as much
// as a body of a ring at most; lighter ones get more mass.
constexpr float kMostMassRatio = 30.0F;
// Box2D takes bodies without any mass, to which specks are rounded, for ones of mass 1.
constexpr float kLightest = 1e-15F;
// A body that crosses more than this share of its radius in one step could jump a wall, so it is swept.
constexpr float kSweptShare = 0.5F;

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
        throw ConfigError(
            "the arena is too small to build walls: its corners lie less than 1 mm apart. Enlarge arena_surface "
            "(mm^2)");
    }
    // Chains push to one side: inwards for the outer wall, outwards for holes.
    bool const clockwise_on_screen = signed_area(polygon) > 0.0;
    if (clockwise_on_screen == outer) {
        std::reverse(corners.begin(), corners.end());
    }
    return corners;
}

/// All shapes have their centre of mass at their origin. Box2D does not weigh them: it aborts at a polygon of less than
/// 0.001 mm^2. `gyration2`: square of the radius of gyration.
void set_mass(b2Body& body, float mass, float gyration2) {
    float const at_least = std::max(mass, kLightest);
    b2MassData const data{.mass = at_least, .center = b2Vec2_zero, .I = at_least * gyration2};
    body.SetMassData(&data);
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
        float const edge_mm = std::hypot(edge.x, edge.y);  // squares of specks would be 0
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

void add_shape(b2Body& body, Shape const& shape, b2FixtureDef const& fixture) {
    if (shape.kind == ShapeKind::rectangle || shape.kind == ShapeKind::triangle) {
        add_polygon(body, outline(shape), fixture);
    } else {
        add_disk(body, bounding_radius(shape), fixture);
    }
}

/// Sub-steps of one step: see kApproachMm. Counts what the motors ask for; collisions make few bodies a little faster.
int substeps_for(World const& world) {
    float fastest_mm2_s2 = 0.0F;
    for (Drive const& drive : world.robots.drive) {
        fastest_mm2_s2 = std::max(fastest_mm2_s2, squared_length(drive.velocity_mm_s));
    }
    auto const approach_mm = 2.0F * std::sqrt(fastest_mm2_s2) * static_cast<float>(world.time_step_s);
    // Speeds are round numbers, give or take a rounding.
    constexpr float tolerance = 1e-3F;
    float const substeps = std::ceil(approach_mm / kApproachMm - tolerance);
    return static_cast<int>(std::clamp(substeps, 1.0F, static_cast<float>(kMaxSubsteps)));
}

class Box2dEngine final : public PhysicsEngine {
public:
    Box2dEngine(World const& world, WallSpec const& walls) : filter_(world), engine_(b2Vec2_zero) {
        engine_.SetContinuousPhysics(false);
        engine_.SetAutoClearForces(false);  // there are none
        engine_.SetContactFilter(&filter_);
        if (!world.periodic) {
            add_walls(world.arena, walls);
        }
        for (std::size_t i = 0; i < world.bodies.size(); ++i) {
            bodies_.push_back(add_body(world.bodies, i));
        }
        add_mass_to_rings(world);
        for (Joint const& joint : world.joints) {
            add_joint(joint, kMostSwingsPerStep / static_cast<float>(world.time_step_s));
        }
        for (Ring const& ring : world.rings) {
            areas_.emplace_back(ring, bodies_);
        }
    }

    void advance(World& world) override {
        impose_drives(world);
        if (!any_awake_) {
            return;  // nothing moves, as in a swarm that only talks
        }
        int const substeps = substeps_for(world);
        Iterations const iterations = world.joints.empty() ? kForContacts : kForJoints;
        auto const dt_s = static_cast<float>(world.time_step_s / substeps);
        for (int i = 0; i < substeps; ++i) {
            for (RingArea const& area : areas_) {
                area.push(dt_s);
            }
            engine_.Step(dt_s, iterations.velocity, iterations.position);
        }
        if (world.periodic) {
            wrap_objects(world, bodies_);
        }
        any_awake_ = false;
        for (Object const& object : world.objects) {
            for (std::uint32_t k = 0; k < object.body_count; ++k) {
                read_back(world.bodies, object.body + k);
            }
        }
    }

private:
    void add_walls(Arena const& arena, WallSpec const& walls) {
        b2BodyDef definition;
        b2Body* const ground = engine_.CreateBody(&definition);
        for (std::size_t i = 0; i < arena.polygons.size(); ++i) {
            std::vector<b2Vec2> const corners = wall_corners(arena.polygons[i], i == 0);
            b2ChainShape chain;
            chain.m_radius = kSkin;
            chain.CreateLoop(corners.data(), static_cast<int32>(corners.size()));
            b2FixtureDef fixture;
            fixture.userData.pointer = kNone;
            fixture.shape = &chain;
            fixture.friction = walls.friction;
            fixture.restitution = walls.restitution;
            fixture.restitutionThreshold = kRestitutionThreshold;
            ground->CreateFixture(&fixture);
        }
    }

    b2Body* add_body(Bodies const& bodies, std::size_t i) {
        b2BodyDef definition;
        definition.type = b2_dynamicBody;
        definition.position = to_box2d(bodies.position_mm[i]);
        definition.angle = bodies.heading_rad[i];
        definition.linearVelocity = to_box2d(bodies.velocity_mm_s[i]);
        definition.angularVelocity = bodies.spin_rad_s[i];
        definition.linearDamping = bodies.spec[i].linear_damping;
        definition.angularDamping = bodies.spec[i].angular_damping;
        b2Body* const body = engine_.CreateBody(&definition);
        b2FixtureDef fixture;
        fixture.userData.pointer = i;
        fixture.density = bodies.spec[i].density;
        fixture.friction = bodies.spec[i].friction;
        fixture.restitution = bodies.spec[i].restitution;
        fixture.restitutionThreshold = kRestitutionThreshold;
        add_shape(*body, bodies.shape[i], fixture);
        return body;
    }

    /// Mass scaling: see kMostMassRatio.
    void add_mass_to_rings(World const& world) {
        float heaviest = 0.0F;
        for (std::size_t i = 0; i < world.robots.size(); ++i) {
            if (world.spec_of(i).has_wheels) {
                heaviest = std::max(heaviest, bodies_[world.robots.body[i]]->GetMass());
            }
        }
        for (Ring const& ring : world.rings) {
            for (std::uint32_t k = 0; k < ring.body_count; ++k) {
                b2Body& body = *bodies_[ring.body + k];
                float const factor = heaviest / (kMostMassRatio * body.GetMass());
                if (factor > 1.0F) {
                    set_mass(body, factor * body.GetMass(), body.GetInertia() / body.GetMass());
                }
            }
        }
    }

    void impose_drives(World& world) {
        Robots& robots = world.robots;
        for (std::size_t i = 0; i < robots.size(); ++i) {
            Drive& drive = robots.drive[i];
            if (!drive.fresh) {
                continue;
            }
            drive.fresh = false;
            b2Body& body = *bodies_[robots.body[i]];
            body.SetLinearVelocity(to_box2d(drive.velocity_mm_s));
            body.SetAngularVelocity(drive.spin_rad_s);
            any_awake_ = any_awake_ || body.IsAwake();
            sweep_if_fast(body, drive, world.bodies.radius_mm[robots.body[i]], world.time_step_s);
        }
    }

    /// Continuous collision detection costs, so only those use it who need it.
    void sweep_if_fast(b2Body& body, Drive const& drive, float radius_mm, double time_step_s) {
        double const step_mm = length(drive.velocity_mm_s) * time_step_s;
        if (step_mm > kSweptShare * radius_mm) {
            engine_.SetContinuousPhysics(true);
            body.SetBullet(true);
        }
    }

    void add_joint(Joint const& joint, float stiffest_hz) {
        b2Body* const a = bodies_[joint.a];
        b2Body* const b = bodies_[joint.b];
        b2Vec2 const at_a = a->GetWorldPoint(to_box2d(joint.anchor_a_mm));
        if (joint.length_mm == 0.0F) {
            b2RevoluteJointDef hinge;
            hinge.Initialize(a, b, at_a);
            engine_.CreateJoint(&hinge);
            return;
        }
        b2DistanceJointDef spring;
        spring.Initialize(a, b, at_a, b->GetWorldPoint(to_box2d(joint.anchor_b_mm)));
        spring.collideConnected = true;  // the filter decides
        spring.length = joint.length_mm / kMmPerUnit;
        spring.minLength = 0.0F;
        spring.maxLength = joint.max_stretch > 0.0F ? (1.0F + joint.max_stretch) * spring.length : b2_maxFloat;
        float const frequency_hz = std::min(joint.stiffness_hz, stiffest_hz);
        b2LinearStiffness(spring.stiffness, spring.damping, frequency_hz, joint.damping_ratio, a, b);
        engine_.CreateJoint(&spring);
    }

    void read_back(Bodies& bodies, std::size_t i) {
        b2Body const& body = *bodies_[i];
        if (!body.IsAwake()) {
            bodies.velocity_mm_s[i] = {};
            bodies.spin_rad_s[i] = 0.0F;
            return;
        }
        any_awake_ = true;
        b2Transform const& pose = body.GetTransform();
        bodies.position_mm[i] = from_box2d(pose.p);
        bodies.axis[i] = {pose.q.c, pose.q.s};
        bodies.heading_rad[i] = body.GetAngle();
        bodies.velocity_mm_s[i] = from_box2d(body.GetLinearVelocity());
        bodies.spin_rad_s[i] = body.GetAngularVelocity();
    }

    RingFilter filter_;
    b2World engine_;
    bool any_awake_ = true;
    std::vector<RingArea> areas_;
    std::vector<b2Body*> bodies_;  // owned by engine_; index as in World::bodies
};

}  // namespace

std::unique_ptr<PhysicsEngine> make_box2d_engine(World const& world, WallSpec const& walls) {
    return std::make_unique<Box2dEngine>(world, walls);
}

}  // namespace pogosim
