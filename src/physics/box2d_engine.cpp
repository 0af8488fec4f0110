// Rigid bodies with Box2D 2.4.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "base/random.hpp"
#include "physics/assemblies.hpp"
#include "physics/assert_motion.hpp"
#include "physics/box2d_shapes.hpp"
#include "physics/box2d_units.hpp"
#include "physics/coinciding_centres.hpp"
#include "physics/membrane_area.hpp"
#include "physics/membrane_filter.hpp"
#include "physics/membrane_mass.hpp"
#include "physics/membrane_sides.hpp"
#include "physics/membrane_steps.hpp"
#include "physics/physics_engine.hpp"
#include "physics/position_correction.hpp"
#include "physics/seam.hpp"
#include "physics/step_start.hpp"

namespace pogosim {

namespace {

struct Iterations {
    int velocity;
    int position;
};
constexpr Iterations kContactIterations{6, 3};
constexpr Iterations kJointIterations{12, 6};  // an impulse has to travel round a membrane
// Box2D detects a contact only once it exists, so a pair overlaps by the distance travelled since. Steps are cut into
// sub-steps in which no two robots at full speed approach by more than this, as long as that is not too many.
constexpr float kApproachMm = 1.0F;
constexpr int kMaxSubsteps = 8;
// Box2D cuts off what a body moves or turns beyond these in one step.
constexpr float kMostMotionMm = 0.99F * b2_maxTranslation * kMmPerUnit;
constexpr float kMostTurnRad = 0.99F * b2_maxRotation;
// Up to this many bodies get their shapes in the order of the bodies: see order_of_shapes().
constexpr std::size_t kMostInOrder = 65536;
// Box2D calls slower collisions inelastic; its own limit of 1 unit/s is the full speed of a robot.
constexpr float kRestitutionThreshold = 0.05F;  // units/s
// A body that crosses more than this share of its radius in one step could pass through a wall, so it gets continuous
// collision detection.
constexpr float kSweptShare = 0.5F;

/// The order in which bodies get their shapes. Box2D's tree of shapes becomes unbalanced if neighbours are inserted one
/// after the other, in the order in which formations place them: finding pairs among 70000 robots on a grid then takes
/// minutes. A shuffled order avoids this. Smaller swarms keep the order of the bodies, on which the last bits depend.
std::vector<std::uint32_t> order_of_shapes(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    if (count > kMostInOrder) {
        std::ranges::sort(order, {}, [](std::uint32_t body) { return mix64(body); });
    }
    return order;
}

struct Fastest {
    float mm2_s2 = 0.0F;
    float rad_s = 0.0F;

    void count(Vec2 velocity_mm_s, float angular_velocity_rad_s) {
        mm2_s2 = std::max(mm2_s2, squared_length(velocity_mm_s));
        rad_s = std::max(rad_s, std::abs(angular_velocity_rad_s));
    }
};

/// The highest speed that motors command; collisions make only few bodies faster than that. Includes the velocities in
/// the world if something other than the motors has set them.
Fastest fastest_of(World const& world, bool others_set_velocities) {
    Fastest fastest;
    for (VelocityCommand const& command : world.robots.command) {
        fastest.count(command.velocity_mm_s, command.angular_velocity_rad_s);
    }
    for (std::size_t i = 0; others_set_velocities && i < world.bodies.size(); ++i) {
        fastest.count(world.bodies.velocity_mm_s[i], world.bodies.angular_velocity_rad_s[i]);
    }
    return fastest;
}

/// Sub-steps of one step: see kApproachMm and most_motion_mm().
int substeps_for(Fastest const& fastest, float most_motion_mm, double time_step_s) {
    auto const step_s = static_cast<float>(time_step_s);
    float const motion_mm = std::sqrt(fastest.mm2_s2) * step_s;
    // Speeds are round numbers, apart from rounding errors.
    constexpr float tolerance = 1e-3F;
    float const fine = std::ceil(2.0F * motion_mm / kApproachMm - tolerance);
    float const needed = std::ceil(std::max(motion_mm / most_motion_mm, fastest.rad_s * step_s / kMostTurnRad));
    float const substeps = std::max(std::clamp(fine, 1.0F, static_cast<float>(kMaxSubsteps)), needed);
    return static_cast<int>(std::min(substeps, static_cast<float>(kMostSubsteps)));
}

bool is_finite(b2Body const& body) {
    return body.GetPosition().IsValid() && std::isfinite(body.GetAngle());
}

/// A fixture's user data is the index of its body, kNone for walls.
class Filter final : public b2ContactFilter {
public:
    explicit Filter(World const& world) : membranes_(world), body_count_(world.bodies.size()) {}

    bool ShouldCollide(b2Fixture* a, b2Fixture* b) override {
        std::uintptr_t const body_a = a->GetUserData().pointer;
        std::uintptr_t const body_b = b->GetUserData().pointer;
        return body_a >= body_count_ || body_b >= body_count_ ||
               membranes_.may_collide(static_cast<std::uint32_t>(body_a), static_cast<std::uint32_t>(body_b));
    }

private:
    MembraneFilter membranes_;
    std::size_t body_count_;
};

/// A membrane, in the units of Box2D.
struct Line {
    std::span<b2Body* const> bodies;

    std::size_t size() const { return bodies.size(); }
    Vec2 position(std::size_t i) const { return {bodies[i]->GetWorldCenter().x, bodies[i]->GetWorldCenter().y}; }
    Vec2 velocity(std::size_t i) const { return {bodies[i]->GetLinearVelocity().x, bodies[i]->GetLinearVelocity().y}; }
    float inverse_mass(std::size_t i) const { return 1.0F / bodies[i]->GetMass(); }
    void push(std::size_t i, Vec2 change) const {
        bodies[i]->SetLinearVelocity(bodies[i]->GetLinearVelocity() + b2Vec2{change.x, change.y});
    }
};

class Box2dEngine final : public PhysicsEngine {
public:
    Box2dEngine(World const& world, WallSpec const& walls)
        : filter_(world),
          engine_(std::make_unique<b2World>(b2Vec2_zero)),
          most_motion_mm_(most_motion_mm(world, kMostMotionMm)) {
        engine_->SetContinuousPhysics(false);
        engine_->SetAutoClearForces(false);  // there are none
        engine_->SetContactFilter(&filter_);
        if (!world.periodic) {
            add_walls(world.arena, walls);
            position_correction_.emplace(world);
        }
        for (std::size_t i = 0; i < world.bodies.size(); ++i) {
            bodies_.push_back(add_body(world.bodies, i));
        }
        if (position_correction_) {
            contain_from_here();
        }
        for (std::uint32_t const i : order_of_shapes(world.bodies.size())) {
            add_shape_of(world.bodies, i);
        }
        scale_masses(world);
        for (Joint const& joint : world.joints) {
            add_joint(joint, kMostSwingsPerStep / static_cast<float>(world.time_step_s));
        }
        follow_links(world);
        for (Membrane const& membrane : world.membranes) {
            areas_.emplace_back(line_of(membrane));
        }
        if (!world.membranes.empty()) {
            sides_.emplace(world);
        }
    }

    void advance(World& world) override {
        take_over(world);
        impose_commands(world);
        if (!any_awake_) {
            start_.note_still(world.bodies);  // as in a swarm that only communicates
            return;
        }
        start_.note(world.bodies);
        int const substeps =
            substeps_for(fastest_of(world, others_set_velocities_), most_motion_mm_, world.time_step_s);
        bool const is_held = !world.joints.empty() || !world.links.empty();
        Iterations const iterations = is_held ? kJointIterations : kContactIterations;
        auto const dt_s = static_cast<float>(world.time_step_s / substeps);
        for (int i = 0; i < substeps; ++i) {
            push_areas(world, dt_s);
            step(dt_s, iterations);
        }
        write_tensions(world, 1.0F / dt_s);
        break_links(world);
        if (position_correction_) {
            hold_in_walls();
        }
        any_awake_ = false;
        for (Object const& object : world.objects) {
            for (std::uint32_t k = 0; k < object.body_count; ++k) {
                read_back(world.bodies, object.body + k);
            }
        }
        if (sides_) {
            hold_on_their_sides(world);
        }
        if (world.periodic) {
            set_poses(world.bodies, seam_.wrap_objects(world));
            if (sides_) {
                sides_->look_again(world);
            }
        }
        assert_motion(world.bodies);
    }

    MotionLimits motion_limits() const override {
        return {.motion_mm = kMostSubsteps * most_motion_mm_,
                .turn_rad = kMostSubsteps * kMostTurnRad,
                .is_of_membranes = most_motion_mm_ < kMostMotionMm};
    }

    TouchGaps touch_gaps() const override {
        constexpr float kSlopMm = b2_linearSlop * kMmPerUnit;
        constexpr float kSkinMm = b2_polygonRadius * kMmPerUnit;  // of walls
        return {.bodies_mm = kSlopMm, .walls_mm = kSkinMm + kSlopMm};
    }

private:
    void take_over(World& world) {
        if (link_changes_ != world.link_changes) {
            follow_links(world);
        }
        Bodies& bodies = world.bodies;
        for (WrittenBody const& written : bodies.written) {
            take_over_velocity(world, written.body);
        }
        std::vector<std::uint32_t> const moved = moved_bodies(bodies);
        bodies.written.clear();
        if (!moved.empty()) {
            take_over_poses(world, moved);
        }
    }

    void step(float dt_s, Iterations iterations) {
        try {
            engine_->Step(dt_s, iterations.velocity, iterations.position);
        } catch (std::bad_alloc const&) {
            // Box2D cannot clean up a step that was cut short: its stack asserts that nothing is left on it.
            static_cast<void>(engine_.release());
            throw;
        }
    }

    Line line_of(Membrane const& membrane) const {
        return {std::span(bodies_).subspan(membrane.body, membrane.body_count)};
    }

    void push_areas(World const& world, float dt_s) const {
        for (std::size_t i = 0; i < areas_.size(); ++i) {
            Line const line = line_of(world.membranes[i]);
            if (line.bodies.front()->IsAwake()) {  // joints let all of them sleep together
                areas_[i].push(line, dt_s);
            }
        }
    }

    void hold_on_their_sides(World& world) {
        std::vector<std::uint32_t> const& put_back = sides_->hold(world);
        set_poses(world.bodies, put_back);
        for (std::uint32_t const i : put_back) {
            bodies_[i]->SetLinearVelocity(b2Vec2_zero);
            bodies_[i]->SetAngularVelocity(0.0F);
            if (position_correction_) {
                position_correction_->start_from(i, world.bodies.position_mm[i]);
            }
        }
    }

    void set_poses(Bodies const& bodies, std::span<std::uint32_t const> of) {
        for (std::uint32_t const i : of) {
            bodies_[i]->SetTransform(to_box2d(bodies.position_mm[i]), bodies.heading_rad[i]);
        }
    }

    void take_over_poses(World& world, std::vector<std::uint32_t> const& moved) {
        Bodies& bodies = world.bodies;
        part_coinciding_centres(bodies.position_mm, moved);
        for (std::uint32_t const i : moved) {
            b2Body& body = *bodies_[i];
            body.SetTransform(to_box2d(bodies.position_mm[i]), bodies.heading_rad[i]);
            b2Rot const& rotation = body.GetTransform().q;
            bodies.heading_dir[i] = {rotation.c, rotation.s};
        }
        // A fixed body would not wake those it lands on.
        for (b2Body* const body : bodies_) {
            body->SetAwake(true);
        }
        any_awake_ = true;
        if (position_correction_) {
            contain_from_here();
        }
        if (sides_) {
            sides_->look_again(world);
        }
    }

    void take_over_velocity(World& world, std::uint32_t i) {
        Bodies const& bodies = world.bodies;
        b2Body& body = *bodies_[i];
        body.SetLinearVelocity(to_box2d(bodies.velocity_mm_s[i]));
        body.SetAngularVelocity(bodies.angular_velocity_rad_s[i]);
        bool const moves = bodies.velocity_mm_s[i] != Vec2{} || bodies.angular_velocity_rad_s[i] != 0.0F;
        others_set_velocities_ = others_set_velocities_ || moves;
        any_awake_ = any_awake_ || body.IsAwake();
        sweep_if_fast(body, bodies.velocity_mm_s[i], bodies.radius_mm[i], world.time_step_s);
    }

    /// Walls that add energy would make bodies faster without end.
    void limit_bounces() {
        if (!walls_add_energy_) {
            return;
        }
        constexpr float most = kMostBounceMmS / kMmPerUnit;
        for (b2Body* const body : bodies_) {
            float const speed = body->GetLinearVelocity().Length();
            if (speed > most) {
                body->SetLinearVelocity((most / speed) * body->GetLinearVelocity());
            }
        }
    }

    /// A pose that is not finite becomes the last one, at rest.
    void hold_in_walls() {
        limit_bounces();
        for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
            b2Body& body = *bodies_[i];
            if (!body.IsAwake() || body.GetType() == b2_staticBody) {
                continue;
            }
            if (!is_finite(body)) {
                body.SetTransform(to_box2d(position_correction_->last(i)), 0.0F);
                body.SetLinearVelocity(b2Vec2_zero);
                body.SetAngularVelocity(0.0F);
            }
            Vec2 const place_mm = from_box2d(body.GetPosition());
            Vec2 const held_mm = position_correction_->hold(i, place_mm);
            if (held_mm != place_mm) {
                body.SetTransform(to_box2d(held_mm), body.GetAngle());
                position_correction_->start_from(i, from_box2d(body.GetPosition()));
            }
        }
    }

    void contain_from_here() {
        for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
            position_correction_->start_from(i, from_box2d(bodies_[i]->GetPosition()));
        }
    }

    void add_walls(Arena const& arena, WallSpec const& walls) {
        walls_add_energy_ = walls.restitution > 1.0F;
        b2BodyDef definition;
        b2Body* const ground = engine_->CreateBody(&definition);
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
        return engine_->CreateBody(&definition);
    }

    void add_shape_of(Bodies const& bodies, std::uint32_t i) {
        b2FixtureDef fixture;
        fixture.userData.pointer = i;
        fixture.density = bodies.spec[i].density;
        fixture.friction = bodies.spec[i].friction;
        fixture.restitution = bodies.spec[i].restitution;
        fixture.restitutionThreshold = kRestitutionThreshold;
        add_shape(*bodies_[i], bodies.shape[i], fixture);
    }

    void scale_masses(World const& world) {
        std::vector<float> mass;
        for (b2Body const* const body : bodies_) {
            mass.push_back(body->GetMass());
        }
        add_mass_to_membranes(world, mass);
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            b2Body& body = *bodies_[i];
            if (mass[i] > body.GetMass()) {
                set_mass(body, mass[i], body.GetInertia() / body.GetMass());
            }
        }
    }

    void impose_commands(World& world) {
        take_commands(world, [&](std::uint32_t i, VelocityCommand const& command) {
            b2Body& body = *bodies_[i];
            body.SetLinearVelocity(to_box2d(command.velocity_mm_s));
            body.SetAngularVelocity(command.angular_velocity_rad_s);
            any_awake_ = any_awake_ || body.IsAwake();
            sweep_if_fast(body, command.velocity_mm_s, world.bodies.radius_mm[i], world.time_step_s);
        });
    }

    /// Continuous collision detection is expensive, so only the bodies that need it use it.
    void sweep_if_fast(b2Body& body, Vec2 velocity_mm_s, float radius_mm, double time_step_s) {
        double const step_mm = length(velocity_mm_s) * time_step_s;
        if (step_mm > kSweptShare * radius_mm) {
            engine_->SetContinuousPhysics(true);
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
            engine_->CreateJoint(&hinge);
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
        engine_->CreateJoint(&spring);
    }

    /// Makes what has been linked, and lets go of what has been cut.
    void follow_links(World const& world) {
        link_changes_ = world.link_changes;
        links_.resize(world.links.size());
        for (std::size_t i = 0; i < links_.size(); ++i) {
            Link const& link = world.links[i];
            if (link.is_cut && links_[i] != nullptr) {
                engine_->DestroyJoint(links_[i]);
                links_[i] = nullptr;
            } else if (!link.is_cut && links_[i] == nullptr) {
                links_[i] = link.kind == LinkKind::hinge ? add_hinge(link) : add_distance(link);
            }
        }
        for (b2Body* const body : bodies_) {
            body->SetAwake(true);
        }
        any_awake_ = true;
    }

    b2Body* end_of(std::uint32_t body) {
        if (body != kNone) {
            return bodies_[body];
        }
        if (ground_ == nullptr) {
            b2BodyDef const still;
            ground_ = engine_->CreateBody(&still);
        }
        return ground_;
    }

    template <class Definition>
    void attach(Definition& joint, Link const& link) {
        joint.bodyA = end_of(link.a);
        joint.bodyB = end_of(link.b);
        joint.localAnchorA = to_box2d(link.end_a_mm);
        joint.localAnchorB = to_box2d(link.end_b_mm);
    }

    b2Joint* add_hinge(Link const& link) {
        b2RevoluteJointDef hinge;
        attach(hinge, link);
        hinge.referenceAngle = link.rest_rad;
        hinge.enableLimit = std::isfinite(link.least_rad) || std::isfinite(link.most_rad);
        hinge.lowerAngle = std::max(link.least_rad, -b2_maxFloat);
        hinge.upperAngle = std::min(link.most_rad, b2_maxFloat);
        return engine_->CreateJoint(&hinge);
    }

    b2Joint* add_distance(Link const& link) {
        b2DistanceJointDef line;
        attach(line, link);
        line.collideConnected = true;
        line.length = link.length_mm / kMmPerUnit;
        bool const is_rod = link.kind == LinkKind::rod;
        line.minLength = is_rod ? line.length : 0.0F;
        line.maxLength = is_rod ? line.length : b2_maxFloat;
        line.stiffness = is_rod ? 0.0F : link.stiffness_n_m;
        line.damping = is_rod ? 0.0F : link.damping_n_s_m;
        return engine_->CreateJoint(&line);
    }

    /// In the last sub-step.
    void write_tensions(World& world, float per_dt) const {
        constexpr float newton = 1e-3F * kMmPerUnit;  // per unit of force
        for (std::size_t i = 0; i < links_.size(); ++i) {
            Link& link = world.links[i];
            if (links_[i] == nullptr) {
                continue;
            }
            b2Vec2 const force = links_[i]->GetReactionForce(per_dt);
            b2Vec2 const way = links_[i]->GetAnchorB() - links_[i]->GetAnchorA();
            float const sign = link.kind == LinkKind::hinge || b2Dot(force, way) < 0.0F ? 1.0F : -1.0F;
            link.tension_n = sign * newton * force.Length();
        }
    }

    void read_back(Bodies& bodies, std::size_t i) {
        b2Body& body = *bodies_[i];
        if (bodies.spec[i].fixed) {
            return;
        }
        if (!body.IsAwake()) {
            bodies.velocity_mm_s[i] = {};
            bodies.angular_velocity_rad_s[i] = 0.0F;
            return;
        }
        any_awake_ = true;
        b2Transform const& pose = body.GetTransform();
        bodies.position_mm[i] = from_box2d(pose.p);
        bodies.heading_rad[i] = wrap_angle(body.GetAngle());
        if (bodies.heading_rad[i] != body.GetAngle()) {
            body.SetTransform(pose.p, bodies.heading_rad[i]);
        }
        bodies.heading_dir[i] = {pose.q.c, pose.q.s};
        bodies.velocity_mm_s[i] = from_box2d(body.GetLinearVelocity());
        bodies.angular_velocity_rad_s[i] = body.GetAngularVelocity();
    }

    Filter filter_;
    std::unique_ptr<b2World> engine_;
    float most_motion_mm_;                                   // in a sub-step
    std::optional<PositionCorrection> position_correction_;  // none in a periodic world, which has no walls
    std::optional<MembraneSides> sides_;                     // when there are membranes
    StepStart start_;
    Seam seam_;
    bool any_awake_ = true;
    bool walls_add_energy_ = false;
    bool others_set_velocities_ = false;  // up to now, something other than the motors has set some
    std::vector<MembraneArea> areas_;
    std::vector<b2Body*> bodies_;  // owned by engine_; index as in World::bodies
    std::vector<b2Joint*> links_;  // the same; null: cut
    b2Body* ground_ = nullptr;     // to which links to the arena are attached
    std::uint32_t link_changes_ = 0;
};

}  // namespace

bool has_box2d_engine() {
    return true;
}

std::unique_ptr<PhysicsEngine> make_box2d_engine(World const& world, WallSpec const& walls, WorkerPool& /*workers*/) {
    return std::make_unique<Box2dEngine>(world, walls);
}

}  // namespace pogosim
