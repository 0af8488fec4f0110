// How long the functions of a program in C take on the robot's processor: `cpu_time: counted` with `function_costs`.
//
// The code runs on this computer, in no time of the robot's clock. What its firmware would have taken is added when the
// main loop's call of the function is over, and the robot waits for it: messages arrive meanwhile, and a long user_step
// makes the tick late. What the clock has shown in loops that wait by it is in both, and counts once.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "process/program_image.hpp"
#include "robot/controller.hpp"
#include "world/specs.hpp"

namespace pogosim {

class FunctionTimes {
public:
    /// Those of a category. Costs name functions as the program does or, in C++, by their symbols. Warns of names that
    /// are none of its functions.
    FunctionTimes(std::string const& category, RobotSpec const& spec, ProgramImage const& image);

    /// Time of the main loop itself in a tick, us.
    double main_loop_us() const { return main_loop_us_; }

    /// Time of a call, us. 0 for a function without costs, which is noted.
    double of(void (*function)()) const;

    /// Tells of functions of the program that the main loop has called and that have no costs.
    void tell_at_end() const;

private:
    struct Time {
        std::uintptr_t function = 0;  // address
        double us = 0.0;
    };

    bool add(std::string const& name, double us, std::span<std::string const> names);
    void note_without_costs(std::uintptr_t function) const;

    std::string category_;
    std::uintptr_t load_address_;
    std::vector<ProgramFunction> functions_;  // of the program
    std::vector<Time> times_;                 // few, so they are searched one by one
    double main_loop_us_ = 0.0;
    mutable std::array<std::atomic<std::uintptr_t>, 8> without_costs_{};  // functions; several threads may note one
};

/// The running robot has called a function of its program: its clock goes on. `function`: null for none.
void take_time_of(void (*function)());

/// The same for the step of a tick, with the main loop itself.
void take_time_of_tick(void (*step)());

}  // namespace pogosim
