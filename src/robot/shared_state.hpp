// Whether the robots of a program share something that they change: if not, several threads can run them at a time.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "process/program_image.hpp"
#include "robot/context.hpp"

namespace pogosim {

/// Why robots must take their steps one after the other; empty: they need not. They share nothing that they could
/// change when all variables of the program are set from the configuration (and then stay as they are, see
/// ConfiguredVariables), and it calls no function outside of the simulator but those without a state, such as
/// sqrtf(). To be called after the program has read its configuration.
std::string why_one_after_the_other(ProgramImage const& image, std::span<BoundVariable const> bound);

/// Why the state of a program cannot be copied, to go on from it later; empty: it can be. It is in variables of the
/// program and in user data, and not in memory that it allocates, nor in a library that it calls.
std::string why_state_is_not_copied(ProgramImage const& image);

/// Why runs of a program cannot follow each other in one process, with its variables set back in between; empty: they
/// can. They cannot where a state cannot be copied, nor where there is code that runs before main() or at the end of
/// the process, such as constructors and destructors of static objects in C++.
std::string why_run_is_not_repeated(ProgramImage const& image);

/// Why a copy of a process (fork) that has loaded the program is not as good as a new process for each run; empty: it
/// is. Code that has run before main() may have asked for the time, for random numbers, or opened a file.
std::string why_process_is_not_copied(ProgramImage const& image);

/// A function of the C library that the program uses, and that calls the program's own code while it keeps values in
/// memory of its own, as qsort() may; empty: there is none.
std::string function_that_calls_back(ProgramImage const& image);

/// Variables of the program that its code may change, in the memory of which robots may have their own copies, and of
/// which nothing is set from the configuration. Empty where that is not known.
std::vector<ProgramSymbols::Variable> variables_of_all_robots(ProgramImage const& image,
                                                              std::span<BoundVariable const> bound);

/// Why robots cannot have own copies of the program's variables; empty: they can.
std::string why_memory_is_shared(ProgramImage const& image);

/// Variables of the program that are set from the configuration. All robots read them.
class ConfiguredVariables {
public:
    ConfiguredVariables(ProgramImage const& image, std::span<BoundVariable const> bound);

    /// Before a step: parameters may have been set since the last one.
    void remember();

    /// The name of one that is not as it was remembered; empty: there is none.
    std::string changed() const;

private:
    struct Variable {
        std::string name;
        std::span<std::byte const> now;
        std::vector<std::byte> remembered;
    };
    std::vector<Variable> variables_;
};

}  // namespace pogosim
