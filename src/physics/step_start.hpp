// What engines do at the start of a step: they note poses, and take over what was written and commanded.
#pragma once

#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// Notes where bodies are at the start of a step.
class StepStart {
public:
    void note(Bodies& bodies) {
        bodies.start_mm = bodies.position_mm;
        bodies.start_rad = bodies.heading_rad;
        was_still_ = false;
    }

    /// The same for a step in which nothing will move.
    void note_still(Bodies& bodies) {
        if (!was_still_) {
            note(bodies);
            was_still_ = true;
        }
    }

    /// What later steps depend on, see state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.was_still_);
    }

private:
    bool was_still_ = false;  // the last step
};

/// Bodies that were put elsewhere since the last step, ascending, each once.
std::vector<std::uint32_t> moved_bodies(Bodies const& bodies);

/// Calls impose(body, command) for each robot whose motors have commanded a velocity since the last step, in their
/// order, unless its body is fixed. Returns whether any motors have.
template <class Impose>
bool take_commands(World& world, Impose const& impose) {
    bool any = false;
    for (std::size_t robot = 0; robot < world.robots.size(); ++robot) {
        VelocityCommand& command = world.robots.command[robot];
        if (!command.pending) {
            continue;
        }
        command.pending = false;
        any = true;
        std::uint32_t const body = world.robots.body[robot];
        if (!world.bodies.spec[body].fixed) {
            impose(body, command);
        }
    }
    return any;
}

}  // namespace pogosim
