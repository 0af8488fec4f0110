// Which robot's code runs, for messages of the crash handler and the watchdog.
#pragma once

#include "process/running_code.hpp"

namespace pogosim {

/// The code of the robots of this process, as the context of each thread has it.
RunningCode const& code_of_robots();

}  // namespace pogosim
