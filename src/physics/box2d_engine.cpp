// Rigid bodies with Box2D 2.4.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/shape.hpp"
#include "physics/box2d_shapes.hpp"
#include "physics/box2d_units.hpp"
#include "physics/containment.hpp"
#include "physics/physics_engine.hpp"
#include "physics/ring_area.hpp"
#include "physics/ring_filter.hpp"
#include "physics/ring_sides.hpp"
#include "physics/wrap_objects.hpp"

namespace pogosim {

namespace {

struct Iterations {
    int velocity;
    int position;
};
constexpr Iterations kForContacts{6, 3};
constexpr Iterations kForJoints{12, 6};  // a pull has to go round a ring
// Box2D detects a contact only once it exists, so a pair overlaps by the distance travelled since. Steps are cut into
// sub-steps in which no two robots at full speed approach by more than this, as long as that is not too many.
constexpr float kApproachMm = 1.0F;
constexpr int kMaxSubsteps = 8;
// Box2D cuts off what a body moves or turns beyond these in one step. Speeds that need more sub-steps get them, up to
// as many as these.
constexpr int kMostSubsteps = 100;
constexpr float kMostMotionMm = 0.99F * b2_maxTranslation * kMmPerUnit;
constexpr float kMostTurnRad = 0.99F * b2_maxRotation;
// The joints of a ring yield to bodies that hit it hard. It holds those that move by up to this share of half its
// thickness per sub-step (found by trial with robots of 5 to 40 mm), or as far as in the sub-steps of slow robots.
constexpr float kRingShare = 0.2F;
constexpr float kLeastRingMotionMm = 0.5F * kApproachMm;
// Box2D calls slower collisions inelastic; its own limit of 1 unit/s is the full speed of a robot.
constexpr float kRestitutionThreshold = 0.05F;  // units/s
// A spring that swings more often than this per step cannot be followed and would shake; it is taken for one that
// swings just so often.
constexpr float kMostSwingsPerStep = 0.5F;
// The solver cannot hold back a heavy body by a chain of light ones. A robot with wheels weighs so many times as much
// as a body of a ring at most; lighter ones get more mass.
constexpr float kMostMassRatio = 30.0F;
// A body that crosses more than this share of its radius in one step could jump a wall, so it is swept.
constexpr float kSweptShare = 0.5F;

// The engine does not know where to push disks with the same centre; those that are so far apart separate.
constexpr float kApartMm = 0.01F;

/// What a body may move in a sub-step: see kMostMotionMm and kRingShare.
float most_motion_mm(World const& world) {
    float most_mm = kMostMotionMm;
    for (Ring const& ring : world.rings) {
        float const half_thickness_mm = inner_radius(world.bodies.shape[ring.body]);
        most_mm = std::min(most_mm, std::max(kRingShare * half_thickness_mm, kLeastRingMotionMm));
    }
    return most_mm;
}

/// Sub-steps of one step: see kApproachMm and most_motion_mm(). Counts what the motors ask for; collisions make few
/// bodies a little faster.
int substeps_for(World const& world, float most_motion_mm) {
    float fastest_mm2_s2 = 0.0F;
    float fastest_rad_s = 0.0F;
    for (Drive const& drive : world.robots.drive) {
        fastest_mm2_s2 = std::max(fastest_mm2_s2, squared_length(drive.velocity_mm_s));
        fastest_rad_s = std::max(fastest_rad_s, std::abs(drive.angular_velocity_rad_s));
    }
    auto const step_s = static_cast<float>(world.time_step_s);
    float const motion_mm = std::sqrt(fastest_mm2_s2) * step_s;
    // Speeds are round numbers, give or take a rounding.
    constexpr float tolerance = 1e-3F;
    float const fine = std::ceil(2.0F * motion_mm / kApproachMm - tolerance);
    float const needed = std::ceil(std::max(motion_mm / most_motion_mm, fastest_rad_s * step_s / kMostTurnRad));
    float const substeps = std::max(std::clamp(fine, 1.0F, static_cast<float>(kMaxSubsteps)), needed);
    return static_cast<int>(std::min(substeps, static_cast<float>(kMostSubsteps)));
}

class Box2dEngine final : public PhysicsEngine {
public:
    Box2dEngine(World const& world, WallSpec const& walls)
        : filter_(world), engine_(b2Vec2_zero), most_motion_mm_(most_motion_mm(world)) {
        engine_.SetContinuousPhysics(false);
        engine_.SetAutoClearForces(false);  // there are none
        engine_.SetContactFilter(&filter_);
        if (!world.periodic) {
            add_walls(world.arena, walls);
            containment_.emplace(world);
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
        if (!world.rings.empty()) {
            sides_.emplace(world, bodies_);
        }
    }

    void advance(World& world) override {
        impose_drives(world);
        if (!any_awake_) {
            return;  // nothing moves, as in a swarm that only talks
        }
        int const substeps = substeps_for(world, most_motion_mm_);
        Iterations const iterations = world.joints.empty() ? kForContacts : kForJoints;
        auto const dt_s = static_cast<float>(world.time_step_s / substeps);
        for (int i = 0; i < substeps; ++i) {
            for (RingArea const& area : areas_) {
                area.push(dt_s);
            }
            engine_.Step(dt_s, iterations.velocity, iterations.position);
        }
        if (containment_) {
            containment_->hold(bodies_);
        }
        if (sides_ && sides_->hold(bodies_) && containment_) {
            containment_->start_from(bodies_);
        }
        if (world.periodic) {
            wrap_objects(world, bodies_);
            if (sides_) {
                sides_->look_again(bodies_);
            }
        }
        any_awake_ = false;
        for (Object const& object : world.objects) {
            for (std::uint32_t k = 0; k < object.body_count; ++k) {
                read_back(world.bodies, object.body + k);
            }
        }
    }

    void set_pose(World& world, Object const& object, Vec2 centre_mm, float heading_rad) override {
        Vec2 motion = centre_mm - pogosim::centre_mm(world, object);
        if (meets_a_centre(world.bodies, object, motion)) {
            motion.x += kApartMm;
        }
        for (std::uint32_t i = object.body; i < object.body + object.body_count; ++i) {
            b2Body& body = *bodies_[i];
            float const angle_rad = object.body_count == 1 ? heading_rad : body.GetAngle();
            body.SetTransform(to_box2d(world.bodies.position_mm[i] + motion), angle_rad);
            body.SetLinearVelocity(b2Vec2_zero);
            body.SetAngularVelocity(0.0F);
            write_pose(world.bodies, i);
        }
        // A fixed body would not wake those it lands on.
        for (b2Body* const body : bodies_) {
            body->SetAwake(true);
        }
        any_awake_ = true;
        if (containment_) {
            containment_->start_from(bodies_);
        }
        if (sides_) {
            sides_->look_again(bodies_);
        }
    }

private:
    /// Whether a body of the object, moved so, has the same centre as one of another object.
    static bool meets_a_centre(Bodies const& bodies, Object const& object, Vec2 motion_mm) {
        std::uint32_t const end = object.body + object.body_count;
        for (std::uint32_t i = object.body; i < end; ++i) {
            Vec2 const place = bodies.position_mm[i] + motion_mm;
            for (std::uint32_t k = 0; k < bodies.size(); ++k) {
                bool const is_other = k < object.body || k >= end;
                if (is_other && squared_length(bodies.position_mm[k] - place) < kApartMm * kApartMm) {
                    return true;
                }
            }
        }
        return false;
    }

    void add_walls(Arena const& arena, WallSpec const& walls) {
        b2BodyDef definition;
        b2Body* const ground = engine_.CreateBody(&definition);
        for (std::size_t i = 0; i < arena.polygons.size(); ++i) {
            b2FixtureDef fixture;
            fixture.userData.pointer = kNone;
            fixture.friction = walls.friction;
            fixture.restitution = walls.restitution;
            fixture.restitutionThreshold = kRestitutionThreshold;
            add_wall(*ground, arena.polygons[i], i == 0, fixture);
        }
    }

    b2Body* add_body(Bodies const& bodies, std::size_t i) {
        b2BodyDef definition;
        definition.type = bodies.spec[i].fixed ? b2_staticBody : b2_dynamicBody;
        definition.position = to_box2d(bodies.position_mm[i]);
        definition.angle = bodies.heading_rad[i];
        definition.linearVelocity = to_box2d(bodies.velocity_mm_s[i]);
        definition.angularVelocity = bodies.angular_velocity_rad_s[i];
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
            body.SetAngularVelocity(drive.angular_velocity_rad_s);
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
        if (bodies.spec[i].fixed) {
            return;
        }
        if (!body.IsAwake()) {
            bodies.velocity_mm_s[i] = {};
            bodies.angular_velocity_rad_s[i] = 0.0F;
            return;
        }
        any_awake_ = true;
        write_pose(bodies, i);
    }

    void write_pose(Bodies& bodies, std::size_t i) const {
        b2Body const& body = *bodies_[i];
        b2Transform const& pose = body.GetTransform();
        bodies.position_mm[i] = from_box2d(pose.p);
        bodies.axis[i] = {pose.q.c, pose.q.s};
        bodies.heading_rad[i] = body.GetAngle();
        bodies.velocity_mm_s[i] = from_box2d(body.GetLinearVelocity());
        bodies.angular_velocity_rad_s[i] = body.GetAngularVelocity();
    }

    RingFilter filter_;
    b2World engine_;
    float most_motion_mm_;                    // in a sub-step
    std::optional<Containment> containment_;  // nobody leaves a periodic world
    std::optional<RingSides> sides_;          // when there are rings
    bool any_awake_ = true;
    std::vector<RingArea> areas_;
    std::vector<b2Body*> bodies_;  // owned by engine_; index as in World::bodies
};

}  // namespace

MotionLimits box2d_motion_limits(World const& world) {
    float const most_mm = most_motion_mm(world);
    return {.motion_mm = kMostSubsteps * most_mm,
            .turn_rad = kMostSubsteps * kMostTurnRad,
            .is_of_rings = most_mm < kMostMotionMm};
}

std::unique_ptr<PhysicsEngine> make_box2d_engine(World const& world, WallSpec const& walls) {
    return std::make_unique<Box2dEngine>(world, walls);
}

}  // namespace pogosim
