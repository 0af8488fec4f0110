// A user program whose functions each test chooses. It stands in for the C program that a simulation normally runs.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "interface/pogobase_inside.hpp"
#include "process/program_image.hpp"

/// User data of the test program.
struct TestData {
    std::array<std::int64_t, 8> number;
};
extern "C" {
DECLARE_USERDATA(TestData)
}

namespace pogosim::testing {

/// The program below, as the simulator sees it.
inline ProgramImage test_program() {
    return linked_program(pogosim_this_program, "test");
}

/// What robot_main() does, for each robot. Set it at the start of a test.
extern std::function<void()> program_main;

/// The usual program: one init and one step for the category "robots".
inline void use_program(void (*init)(), void (*step)()) {
    program_main = [=] {
        pogobot_init();
        pogobot_start(init, step);
    };
}

}  // namespace pogosim::testing
