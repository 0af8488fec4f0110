// Rigid disks, ours: a structure of arrays, a list of near pairs that is kept while nobody has moved far, and a solver
// that sub-steps only bodies in contact. All others move on a straight line, at the cost of reading and writing them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "physics/assert_motion.hpp"
#include "physics/coinciding_centres.hpp"
#include "physics/containment.hpp"
#include "physics/disk_solver.hpp"
#include "physics/known_motion.hpp"
#include "physics/near_pairs.hpp"
#include "physics/near_walls.hpp"
#include "physics/physics_engine.hpp"
#include "physics/sweep.hpp"

namespace pogosim {

namespace {

// Contacts are looked for as far as bodies can come together in a step, if an impact makes them so much faster.
constexpr float kReserve = 1.5F;
constexpr float kLeastReachMm = 0.5F;
// Who moves further than this share of the smallest radius in a step is swept.
constexpr float kSweptShare = 0.5F;

class DiskEngine final : public PhysicsEngine {
public:
    DiskEngine(World const& world, WallSpec const& walls)
        : containment_(world), near_walls_(world, containment_.walls()), near_pairs_(world), solver_(world, walls) {
        Bodies const& bodies = world.bodies;
        if (bodies.size() > 0) {
            ordinary_mm_ = kSweptShare * std::ranges::min(bodies.radius_mm);
        }
        is_damped_ = std::ranges::any_of(bodies.spec, [](BodySpec const& spec) {
            return spec.linear_damping != 0.0F || spec.angular_damping != 0.0F;
        });
        known_.copy(bodies);
    }

    void advance(World& world) override {
        Bodies& bodies = world.bodies;
        take_over(world);
        impose_commands(world);
        auto const dt_s = static_cast<float>(world.time_step_s);
        if (is_damped_) {
            damp(bodies, dt_s);
        }
        float const fastest_mm_s = fastest(bodies);
        if (fastest_mm_s == 0.0F && !turns(bodies) && !solver_.has_overlaps() && !moved_) {
            return;  // nothing moves, as in a swarm that only talks
        }
        moved_ = false;
        float const reach_mm = 2.0F * std::min(std::max(kReserve * fastest_mm_s * dt_s, kLeastReachMm), ordinary_mm_);
        if (!near_pairs_.covers(world, reach_mm)) {
            near_pairs_.build(world, reach_mm);
            near_walls_.build(world, containment_.walls(), near_pairs_.skin_mm());
        }
        solver_.find_contacts(world, near_pairs_, near_walls_, reach_mm);
        starts_.clear();
        for (std::uint32_t const body : solver_.touched()) {
            starts_.push_back({body, bodies.position_mm[body]});
        }
        solver_.solve(world, near_walls_);
        move_others(bodies, dt_s);
        std::erase_if(starts_, [&](Start const& start) { return !is_fast(bodies, start.body, dt_s); });
        if (!starts_.empty()) {
            stop_at_impacts(world, starts_, dt_s);
        }
        hold_in_arena(world, dt_s);
        known_.copy(bodies);
        assert_motion(bodies);
    }

    MotionLimits motion_limits() const override {
        return {.motion_mm = std::numeric_limits<float>::max(),
                .turn_rad = std::numeric_limits<float>::max(),
                .is_of_membranes = false};
    }

private:
    /// Whether a body goes so far in the step that contacts may be too late for it.
    bool is_fast(Bodies const& bodies, std::size_t body, float dt_s) const {
        return squared_length(dt_s * bodies.velocity_mm_s[body]) > ordinary_mm_ * ordinary_mm_;
    }

    /// Bodies without a contact move on a straight line.
    void move_others(Bodies& bodies, float dt_s) {
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            if (bodies.spec[i].fixed) {
                continue;
            }
            if (!solver_.has_contact(i)) {
                if (is_fast(bodies, i, dt_s)) {
                    starts_.push_back({i, bodies.position_mm[i]});
                }
                bodies.position_mm[i] = bodies.position_mm[i] + dt_s * bodies.velocity_mm_s[i];
                bodies.heading_rad[i] += dt_s * bodies.angular_velocity_rad_s[i];
            }
            if (solver_.has_contact(i) || bodies.angular_velocity_rad_s[i] != 0.0F) {
                bodies.heading_dir[i] = direction(bodies.heading_rad[i]);
            }
        }
    }

    void hold_in_arena(World& world, float dt_s) {
        Bodies& bodies = world.bodies;
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            Vec2& place_mm = bodies.position_mm[i];
            if (bodies.spec[i].fixed) {
                continue;
            }
            if (world.periodic) {
                place_mm = wrapped(world, place_mm);
            } else if (is_fast(bodies, i, dt_s)) {
                place_mm = containment_.hold_fast(i, place_mm);
            } else {
                place_mm = containment_.hold(i, place_mm);
            }
        }
    }

    /// Poses and velocities of others than this engine are compared with what it has written last.
    void take_over(World& world) {
        Bodies& bodies = world.bodies;
        if (known_.is_of(bodies)) {
            return;
        }
        std::vector<std::uint32_t> const moved = known_.find_moved(bodies);
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            if (bodies.spec[i].fixed) {
                bodies.velocity_mm_s[i] = {};
                bodies.angular_velocity_rad_s[i] = 0.0F;
            }
        }
        if (!moved.empty()) {
            part_coinciding_centres(bodies.position_mm, moved);
            moved_ = true;
        }
        for (std::uint32_t const i : moved) {
            bodies.heading_dir[i] = direction(bodies.heading_rad[i]);
            containment_.start_from(i, bodies.position_mm[i]);
        }
    }

    static void impose_commands(World& world) {
        Robots& robots = world.robots;
        for (std::size_t i = 0; i < robots.size(); ++i) {
            VelocityCommand& command = robots.command[i];
            if (!command.pending) {
                continue;
            }
            command.pending = false;
            std::uint32_t const body = robots.body[i];
            if (!world.bodies.spec[body].fixed) {
                world.bodies.velocity_mm_s[body] = command.velocity_mm_s;
                world.bodies.angular_velocity_rad_s[body] = command.angular_velocity_rad_s;
            }
        }
    }

    static void damp(Bodies& bodies, float dt_s) {
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            BodySpec const& spec = bodies.spec[i];
            bodies.velocity_mm_s[i] = (1.0F / (1.0F + dt_s * spec.linear_damping)) * bodies.velocity_mm_s[i];
            bodies.angular_velocity_rad_s[i] /= 1.0F + dt_s * spec.angular_damping;
        }
    }

    static float fastest(Bodies const& bodies) {
        float fastest2 = 0.0F;
        for (Vec2 const velocity_mm_s : bodies.velocity_mm_s) {
            fastest2 = std::max(fastest2, squared_length(velocity_mm_s));
        }
        return std::sqrt(fastest2);
    }

    static bool turns(Bodies const& bodies) {
        return std::ranges::any_of(bodies.angular_velocity_rad_s, [](float spin) { return spin != 0.0F; });
    }

    Containment containment_;
    NearWalls near_walls_;
    NearPairs near_pairs_;
    DiskSolver solver_;
    KnownMotion known_;
    std::vector<Start> starts_;  // of bodies with contacts or that are fast, in this step
    float ordinary_mm_ = 1.0F;   // who goes further in a step is fast
    bool is_damped_ = false;
    bool moved_ = true;  // somebody was put elsewhere, perhaps into others
};

}  // namespace

std::string why_unfit_for_disk_engine(World const& world) {
    for (Object const& object : world.objects) {
        std::string const& name = world.categories[object.category].name;
        if (object.body_count > 1) {
            return fmt::format("moves disks only, but '{}' is a membrane", name);
        }
        if (object.body != kNone && world.bodies.shape[object.body].kind != ShapeKind::disk) {
            return fmt::format("moves disks only, but '{}' has another shape", name);
        }
    }
    return "";
}

std::unique_ptr<PhysicsEngine> make_disk_engine(World const& world, WallSpec const& walls) {
    return std::make_unique<DiskEngine>(world, walls);
}

}  // namespace pogosim
