// What a run says about variables that its robots share by mistake, though each real robot has its own.
#pragma once

#include <cstddef>
#include <span>

#include "process/program_image.hpp"
#include "robot/context.hpp"

namespace pogosim {

/// Warns of the variables that the program can modify, by the rules of pogosim-shared-state; not of those in `bound`,
/// which the program has set from the configuration. Only the first time in the process for each program. `robots`:
/// how many run the program. To be called after the program has read its configuration.
///
/// The symbol table, a few kilobytes, tells whether there is anything to look at; the debug information is read only
/// then.
void warn_of_shared_variables(ProgramImage const& image, std::span<BoundVariable const> bound, std::size_t robots);

}  // namespace pogosim
