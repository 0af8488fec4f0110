// The parts of library_functions(), by what they act on.
#pragma once

#include <span>

#include "firmware/firmware_call.hpp"

namespace pogosim {

/// What functions do that only set up hardware: devices are ready at the start of a run.
CallOutcome do_nothing(FirmwareCall& call);

std::span<LibraryFunction const> clock_functions();
std::span<LibraryFunction const> console_functions();
std::span<LibraryFunction const> device_functions();
std::span<LibraryFunction const> flash_functions();
std::span<LibraryFunction const> helper_functions();
std::span<LibraryFunction const> infrared_functions();

}  // namespace pogosim
