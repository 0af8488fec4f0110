// Moves the bodies. A small interface, so that another engine is one more file and a line in the table of
// physics_engine.cpp.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/state_bytes.hpp"
#include "base/worker_pool.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Largest motions that an engine can follow in one time step.
struct MotionLimits {
    float motion_mm;
    float turn_rad;
    bool is_of_membranes;  // motion_mm: it is what the soft membranes of the world can hold back
};

/// Outlines that are no further apart touch, mm: what contacts leave between bodies at rest that are pressed together.
struct TouchGaps {
    float bodies_mm;  // between two bodies
    float walls_mm;   // between a body and a wall of the arena
};

class PhysicsEngine {
public:
    PhysicsEngine() = default;
    virtual ~PhysicsEngine() = default;
    PhysicsEngine& operator=(PhysicsEngine const&) = delete;

    /// Takes over what was written to the bodies of the world from outside, see world.hpp, imposes pending velocity
    /// commands, advances all bodies by one time step and writes their poses and velocities back. Bodies that overlap
    /// are pushed apart in the next steps.
    virtual void advance(World& world) = 0;

    virtual MotionLimits motion_limits() const = 0;

    virtual TouchGaps touch_gaps() const = 0;

    /// A copy, which goes on as this one does with the world as it is now. Null: this engine cannot be copied.
    virtual std::unique_ptr<PhysicsEngine> copy() const { return nullptr; }

    /// What the next steps depend on besides the world, of an engine that can be copied: see state_bytes.hpp.
    virtual void append_state(StateWriter& /*state*/) const {}
    virtual void take_state(StateReader& /*state*/) {}

protected:
    PhysicsEngine(PhysicsEngine const&) = default;
};

/// Stands for the engine that suits every world: our own.
inline constexpr std::string_view kAutomaticEngine = "auto";

/// Names that make_physics_engine() knows: kAutomaticEngine, then the engines.
std::vector<std::string> const& physics_engine_names();

/// The engine that a name stands for: `name` itself, unless it is kAutomaticEngine.
std::string const& physics_engine_behind(std::string const& name);

/// Whether the simulator is built with Box2D.
bool has_box2d_engine();

/// Why this engine cannot move what is in the world, and what can: "is not there: ...; use auto". Empty if it can.
std::string why_unfit(std::string const& name, World const& world, bool has_box2d = has_box2d_engine());

/// An engine for the arena and the bodies as they are in the world now. `name`: one of the known ones. `workers`, which
/// must outlive the engine, share its work where they can; results do not depend on them. Throws ConfigError when the
/// arena is too small to build walls.
std::unique_ptr<PhysicsEngine> make_physics_engine(std::string const& name, World const& world, WallSpec const& walls,
                                                   WorkerPool& workers);

// The engines.
std::unique_ptr<PhysicsEngine> make_disk_engine(World const& world, WallSpec const& walls, WorkerPool& workers);
std::unique_ptr<PhysicsEngine> make_box2d_engine(World const& world, WallSpec const& walls, WorkerPool& workers);

}  // namespace pogosim
