// How long the functions of a program in C take on the robot's processor: `cpu_time: counted` with `function_costs`.
//
// The code runs on this computer, in no time of the robot's clock. What its firmware would have taken is added when the
// main loop's call of the function is over: so a long user_step makes the tick late.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "process/program_image.hpp"
#include "robot/controller.hpp"
#include "world/specs.hpp"

namespace pogosim {

class FunctionTimes {
public:
    /// Those of a category. Warns of names that are not functions of the program.
    FunctionTimes(std::string const& category, RobotSpec const& spec, ProgramImage const& image);

    /// Time of the main loop itself in a tick, us.
    double main_loop_us() const { return main_loop_us_; }

    /// Time of a call, us. 0 for a function that has no costs, which is noted.
    double of(void (*function)()) const;

    /// Tells of functions that the main loop has called and that have no costs.
    void tell_at_end() const;

private:
    struct Time {
        std::uintptr_t function = 0;  // address
        double us = 0.0;
    };

    void add(std::string const& name, double us);

    std::string category_;
    std::uintptr_t load_address_;
    std::vector<ProgramFunction> functions_;  // of the program
    std::vector<Time> times_;                 // few, so they are searched one by one
    double main_loop_us_ = 0.0;
    mutable std::atomic<std::uintptr_t> without_costs_ = 0;  // a function; several threads may note one
};

/// The running robot has called a function of its program: its clock goes on. `function`: null for none.
void take_time_of(void (*function)());

/// The same for the step of a tick, with the main loop itself.
void take_time_of_tick(void (*step)());

}  // namespace pogosim
