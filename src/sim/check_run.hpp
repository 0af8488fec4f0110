// Checks a configuration as far as that is possible without a run.
#pragma once

#include <string>

#include "base/problems.hpp"
#include "config/scenario.hpp"
#include "process/program_image.hpp"
#include "sim/simulation.hpp"

namespace pogosim {

struct CheckOptions {
    RunOptions run{};       // strict, conversions, film, from_state and the times of states count
    std::string picture{};  // file for a picture of the start; empty: none
};

struct CheckResult {
    std::string summary{};  // "50 robots, 2 other objects"; empty if the world could not be built
    bool user_code_was_aborted = false;
    bool interrupted = false;  // by a signal, while the program was checked: there may be other mistakes
};

/// Adds to `problems`, which has those of the scenario: files that are missing, or cannot be written; an arena that is
/// wrong; objects that do not fit; a state that is of another run, which is compared only if the scenario was read
/// without problems; values of parameters that the program refuses. Programs are started, with main(),
/// callback_global_setup and user_init, but can change no file (forbid_effects_of_thread()); nothing is simulated. If
/// the world cannot be built, they are started in another one, with a robot of each category, for their parameters.
/// Only the picture is written, and only if there are no problems. Throws OutputError if it cannot be.
CheckResult check_run(ProgramImage const& program, Scenario const& scenario, CheckOptions options, Problems& problems);

}  // namespace pogosim
