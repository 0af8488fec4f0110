// The parts of library_functions(), by what they act on.
#pragma once

#include <span>

#include "firmware/firmware_call.hpp"

namespace pogosim {

std::span<LibraryFunction const> clock_functions();
std::span<LibraryFunction const> console_functions();
std::span<LibraryFunction const> device_functions();
std::span<LibraryFunction const> flash_functions();
std::span<LibraryFunction const> helper_functions();
std::span<LibraryFunction const> infrared_functions();

}  // namespace pogosim
