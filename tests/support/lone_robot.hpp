// One robot, alone in the world.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim::testing {

/// The only robot of a large arena, after so many seconds of a program. It starts at (2500, 2500) with heading 0.
inline std::unique_ptr<Simulation> run_alone(ObjectSpec const& spec, void (*init)(), void (*step)(), double seconds) {
    use_program(init, step);
    auto simulation = std::make_unique<Simulation>(test_program(), square_scene({robot_at({2500, 2500}, spec)}, 5000.0),
                                                   RunOptions{});
    EXPECT_FALSE(simulation->start());
    EXPECT_FALSE(run_for(*simulation, seconds));
    return simulation;
}

/// A program for the robot: both motors at full power.
inline void full_ahead() {
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
}

}  // namespace pogosim::testing
