// Our own engine for rigid disks and convex polygons: a structure of arrays, a neighbour list that stays valid until a
// body has moved far, and a solver that sub-steps only bodies in contact or held by links. All other bodies move on a
// straight line, at the cost of reading and writing them. Soft membranes are disks joined by springs, or rectangles
// joined by hinges.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/worker_pool.hpp"
#include "physics/assemblies.hpp"
#include "physics/assert_motion.hpp"
#include "physics/coinciding_centres.hpp"
#include "physics/continuous_collision.hpp"
#include "physics/damping.hpp"
#include "physics/island_solver.hpp"
#include "physics/islands.hpp"
#include "physics/membrane_sides.hpp"
#include "physics/membrane_steps.hpp"
#include "physics/near_contacts.hpp"
#include "physics/neighbour_list.hpp"
#include "physics/physics_engine.hpp"
#include "physics/position_correction.hpp"
#include "physics/seam.hpp"
#include "physics/step_start.hpp"
#include "physics/wall_neighbour_list.hpp"

namespace pogosim {

namespace {

// Contacts are sought within the distance that two bodies can close in a step, if an impact speeds them up by this
// factor.
constexpr float kReserve = 1.5F;
constexpr float kLeastReachMm = 0.5F;
// Bodies that move further than this share of the smallest radius in a step get continuous collision detection.
// The bodies of membranes are not counted in that: a body that passes through one is put back.
constexpr float kSweptShare = 0.5F;
// Smallest size of a range that one worker takes.
constexpr std::uint32_t kLeastIslands = 64;
constexpr std::uint32_t kIslandsAhead = 3;  // islands are prefetched so many ahead
constexpr std::uint32_t kLeastBodies = 1024;
// A membrane that has been slower than this for kCalmAfterS is put to rest; a robot's full speed is a hundred times as
// high.
constexpr float kCalmMmS = 1.0F;
constexpr double kCalmAfterS = 0.5;

/// The smallest inner radius of the bodies that are not part of a membrane; of all bodies if there are no others.
float smallest_radius_mm(World const& world) {
    float smallest_mm = std::numeric_limits<float>::max();
    for (Object const& object : world.objects) {
        if (object.body_count == 1) {
            smallest_mm = std::min(smallest_mm, inner_radius(world.bodies.shape[object.body]));
        }
    }
    return smallest_mm < std::numeric_limits<float>::max() ? smallest_mm : std::ranges::min(world.bodies.radius_mm);
}

class DiskEngine final : public PhysicsEngine {
public:
    DiskEngine(World const& world, WallSpec const& walls, WorkerPool& workers)
        : workers_(workers),
          position_correction_(world),
          wall_neighbour_list_(world, position_correction_.walls()),
          neighbour_list_(world),
          contacts_(world, walls, wall_neighbour_list_.sides()),
          damping_(world.bodies),
          assemblies_(world),
          solvers_(workers.size(), IslandSolver(world)),
          continuous_collision_(world) {
        Bodies const& bodies = world.bodies;
        if (bodies.size() > 0) {
            ordinary_mm_ = kSweptShare * smallest_radius_mm(world);
        }
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            if (!bodies.spec[i].fixed) {
                movable_.push_back(i);
                if (contacts_.hulls().is_one(i)) {
                    movable_hulls_.push_back(i);
                }
            }
        }
        if (!world.membranes.empty()) {
            sides_.emplace(world);
            calm_s_.resize(world.membranes.size());
            most_motion_mm_ = kMostSubsteps * most_motion_mm(world, most_motion_mm_);
        }
    }

    void advance(World& world) override {
        Bodies& bodies = world.bodies;
        take_over(world);
        bool const is_driven = impose_commands(world);
        auto const dt_s = static_cast<float>(world.time_step_s);
        damping_.begin_step(bodies, dt_s);
        float const fastest_mm_s = std::max(fastest(bodies), fastest_turn_mm_s(bodies));
        if (fastest_mm_s == 0.0F && !turns(bodies) && !has_overlaps_ && !moved_ && !pulls(world)) {
            start_.note_still(bodies);  // as in a swarm that only communicates
            return;
        }
        start_.note(bodies);
        float const reach_mm = 2.0F * std::min(std::max(kReserve * fastest_mm_s * dt_s, kLeastReachMm), ordinary_mm_);
        if (moved_ || !neighbour_list_.covers(world, reach_mm, workers_)) {
            neighbour_list_.build(world, reach_mm, workers_);
            wall_neighbour_list_.build(world, position_correction_, neighbour_list_.skin_mm());
            contacts_.build(world, assemblies_, neighbour_list_, wall_neighbour_list_);
        }
        some_are_fast_ = fastest_mm_s * dt_s > ordinary_mm_;
        islands_.find(world, assemblies_, contacts_, {.reach_mm = reach_mm, .wakes_assemblies = moved_}, workers_);
        moved_ = false;
        solve_islands(world, is_driven);
        move_others(world, dt_s);
        if (!fast_.empty()) {
            hold_fast(world);
        }
        if (sides_) {
            hold_by_membranes(world);
        }
        damping_.end_step(bodies);
        break_links(world);
        assert_motion(bodies);
    }

    MotionLimits motion_limits() const override {
        return {.motion_mm = most_motion_mm_,
                .turn_rad = std::numeric_limits<float>::max(),
                .is_of_membranes = sides_.has_value()};
    }

    TouchGaps touch_gaps() const override {
        return {.bodies_mm = 2.0F * kContactToleranceMm, .walls_mm = 2.0F * kContactToleranceMm};
    }

    std::unique_ptr<PhysicsEngine> copy() const override { return std::make_unique<DiskEngine>(*this); }

    void append_state(StateWriter& state) const override { visit_state(*this, state); }
    void take_state(StateReader& state) override { visit_state(*this, state); }

    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.position_correction_, self.wall_neighbour_list_, self.neighbour_list_, self.contacts_,
              self.assemblies_, self.start_, self.calm_s_, self.has_overlaps_, self.moved_);
        if (self.sides_) {
            state(*self.sides_);
        }
    }

private:
    /// Islands do not interact, so results do not depend on which worker solves which island.
    void solve_islands(World& world, bool is_driven) {
        std::span<Island const> const islands = islands_.islands();
        auto const count = static_cast<std::uint32_t>(islands.size());
        bool const is_large = fills_caches(world);
        std::atomic<bool> has_overlaps = false;
        workers_.run_ranges(count, kLeastIslands, [&](WorkRange range) {
            IslandSolver& solver = solvers_[range.worker];
            for (std::uint32_t i = range.first; i < range.last; ++i) {
                if (is_large && i + kIslandsAhead < range.last && islands[i + kIslandsAhead].is_active) {
                    solver.expect(world, contacts_, islands_, islands[i + kIslandsAhead]);
                }
                if (islands[i].is_active &&
                    solver.solve(world, assemblies_, contacts_, islands_, islands[i], is_driven)) {
                    has_overlaps = true;
                }
            }
        });
        has_overlaps_ = has_overlaps;
    }

    /// Whether a link will move something that rests.
    static bool pulls(World const& world) {
        return std::ranges::any_of(world.links,
                                   [](Link const& link) { return !link.is_cut && link.tension_n != 0.0F; });
    }

    void move_others(World& world, float dt_s) {
        auto const count = static_cast<std::uint32_t>(movable_.size());
        moved_in_range_.resize(workers_.range_count(count, kLeastBodies));
        workers_.run_ranges(count, kLeastBodies, [&](WorkRange range) {
            Moved& moved = moved_in_range_[range.part];
            moved.fast.clear();
            moved.turned.resize(range.last - range.first);
            std::size_t turned_count = 0;
            for (std::uint32_t const i : std::span(movable_).subspan(range.first, range.last - range.first)) {
                move_other(world, i, dt_s, moved.fast);
                moved.turned[turned_count] = i;
                turned_count += world.bodies.heading_rad[i] != world.bodies.start_rad[i] ? 1 : 0;
            }
            for (std::uint32_t const i : std::span(moved.turned).first(turned_count)) {
                world.bodies.heading_dir[i] = direction(world.bodies.heading_rad[i]);
            }
        });
        fast_.clear();
        for (Moved const& moved : moved_in_range_) {
            fast_.insert(fast_.end(), moved.fast.begin(), moved.fast.end());
        }
    }

    /// Moves a body without contacts on a straight line, and keeps any body inside the arena; in a periodic arena, fast
    /// bodies are wrapped later. Appends to `fast` the fast bodies and those that may have met one. Whether a body has
    /// contacts, and whether it turns, is hard to predict: neither is a branch.
    void move_other(World& world, std::uint32_t i, float dt_s, std::vector<std::uint32_t>& fast) {
        Bodies& bodies = world.bodies;
        bool const has_contact = islands_.has_contact(i);
        std::array const places_mm{bodies.position_mm[i] + dt_s * bodies.velocity_mm_s[i], bodies.position_mm[i]};
        std::array const headings_rad{bodies.heading_rad[i] + dt_s * bodies.angular_velocity_rad_s[i],
                                      bodies.heading_rad[i]};
        Vec2 place_mm = places_mm[has_contact ? 1 : 0];
        bodies.heading_rad[i] = wrap_angle(headings_rad[has_contact ? 1 : 0]);
        float const moved2 = squared_length(place_mm - bodies.start_mm[i]);
        bool const is_fast = moved2 > ordinary_mm_ * ordinary_mm_ || (some_are_fast_ && has_contact);
        if (is_fast) {
            fast.push_back(i);
        }
        if (!world.periodic) {
            place_mm = is_fast ? position_correction_.hold_fast(i, place_mm) : position_correction_.hold(i, place_mm);
        } else if (!is_fast) {
            place_mm = wrapped_alone(world, place_mm);
        }
        bodies.position_mm[i] = place_mm;
    }

    void hold_fast(World& world) {
        for (std::uint32_t const i :
             continuous_collision_.stop_at_impacts(world, contacts_.hulls(), assemblies_, fast_)) {
            Vec2& place_mm = world.bodies.position_mm[i];
            place_mm = world.periodic ? wrapped_alone(world, place_mm) : position_correction_.hold_fast(i, place_mm);
        }
        if (world.periodic) {
            for (std::uint32_t const i : fast_) {
                world.bodies.position_mm[i] = wrapped_alone(world, world.bodies.position_mm[i]);
            }
        }
    }

    /// With membranes in the world, a body inside one is wrapped together with it: see Seam.
    Vec2 wrapped_alone(World const& world, Vec2 place_mm) const { return sides_ ? place_mm : wrapped(world, place_mm); }

    void hold_by_membranes(World& world) {
        for (std::uint32_t const i : sides_->hold(world)) {
            position_correction_.start_from(i, world.bodies.position_mm[i]);
        }
        if (world.periodic) {
            seam_.wrap_objects(world);
            sides_->look_again(world);
        }
        for (std::size_t i = 0; i < calm_s_.size(); ++i) {
            calm_down(world, world.membranes[i], calm_s_[i]);
        }
    }

    static void calm_down(World& world, Membrane const& membrane, double& calm_s) {
        std::span const velocity_mm_s =
            std::span(world.bodies.velocity_mm_s).subspan(membrane.body, membrane.body_count);
        bool const is_calm = std::ranges::all_of(
            velocity_mm_s, [](Vec2 velocity) { return squared_length(velocity) < kCalmMmS * kCalmMmS; });
        calm_s = is_calm ? calm_s + world.time_step_s : 0.0;
        if (calm_s >= kCalmAfterS) {
            std::ranges::fill(velocity_mm_s, Vec2{});
            std::ranges::fill(
                std::span(world.bodies.angular_velocity_rad_s).subspan(membrane.body, membrane.body_count), 0.0F);
        }
    }

    /// Velocities that were written need nothing.
    void take_over(World& world) {
        Bodies& bodies = world.bodies;
        moved_ = assemblies_.follow(world) || moved_;
        std::vector<std::uint32_t> const moved = moved_bodies(bodies);
        bodies.written.clear();
        if (moved.empty()) {
            return;
        }
        moved_ = true;
        part_coinciding_centres(bodies.position_mm, moved);
        for (std::uint32_t const i : moved) {
            bodies.heading_dir[i] = direction(bodies.heading_rad[i]);
            position_correction_.start_from(i, bodies.position_mm[i]);
        }
        if (sides_) {
            sides_->look_again(world);
        }
    }

    /// Returns whether any command was pending.
    static bool impose_commands(World& world) {
        return take_commands(world, [&world](std::uint32_t body, VelocityCommand const& command) {
            world.bodies.velocity_mm_s[body] = command.velocity_mm_s;
            world.bodies.angular_velocity_rad_s[body] = command.angular_velocity_rad_s;
        });
    }

    static float fastest(Bodies const& bodies) {
        float fastest2 = 0.0F;
        for (Vec2 const velocity_mm_s : bodies.velocity_mm_s) {
            fastest2 = std::max(fastest2, squared_length(velocity_mm_s));
        }
        return std::sqrt(fastest2);
    }

    /// The highest speed at which the turning of a hull moves its corners.
    float fastest_turn_mm_s(Bodies const& bodies) const {
        float fastest_mm_s = 0.0F;
        for (std::uint32_t const i : movable_hulls_) {
            fastest_mm_s = std::max(fastest_mm_s, std::abs(bodies.angular_velocity_rad_s[i]) * bodies.radius_mm[i]);
        }
        return fastest_mm_s;
    }

    static bool turns(Bodies const& bodies) {
        return std::ranges::any_of(bodies.angular_velocity_rad_s, [](float spin) { return spin != 0.0F; });
    }

    WorkerPool& workers_;
    PositionCorrection position_correction_;
    WallNeighbourList wall_neighbour_list_;
    NeighbourList neighbour_list_;
    NearContacts contacts_;
    Damping damping_;
    Assemblies assemblies_;
    Islands islands_;
    std::vector<IslandSolver> solvers_;  // one for each worker
    ContinuousCollision continuous_collision_;
    StepStart start_;
    Seam seam_;
    std::optional<MembraneSides> sides_;  // when there are membranes
    std::vector<double> calm_s_;          // of each membrane: how long it has been slow
    std::vector<std::uint32_t> movable_;  // bodies that are not fixed
    std::vector<std::uint32_t> movable_hulls_;
    std::vector<std::uint32_t> fast_;  // bodies in this step
    /// Bodies of one range of movable_ in this step.
    struct Moved {
        std::vector<std::uint32_t> fast;
        std::vector<std::uint32_t> turned;  // and room for all
    };
    std::vector<Moved> moved_in_range_;
    float most_motion_mm_ = std::numeric_limits<float>::max();  // in a step
    float ordinary_mm_ = 1.0F;                                  // a body that moves further in a step is fast
    bool some_are_fast_ = false;                                // before contacts slow them down
    bool has_overlaps_ = false;                                 // some disks overlapped after the last step
    bool moved_ = true;                                         // some body was moved from outside, perhaps into others
};

}  // namespace

std::unique_ptr<PhysicsEngine> make_disk_engine(World const& world, WallSpec const& walls, WorkerPool& workers) {
    return std::make_unique<DiskEngine>(world, walls, workers);
}

}  // namespace pogosim
