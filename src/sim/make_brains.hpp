// Which brains a world needs besides the program.
#pragma once

#include <memory>
#include <vector>

#include "brain/brain.hpp"
#include "firmware/firmware_brain.hpp"
#include "world/world.hpp"

namespace pogosim {

/// The brains of all categories that need no program, in their order. Throws ConfigError, std::bad_alloc.
Brains make_brains(World& world, FirmwareServices const& services);

/// Throws ConfigError if a category that has robots needs a program.
void check_needs_no_program(World const& world);

}  // namespace pogosim
