// The types of lamps that a configuration can name, and with them all types.
#pragma once

#include <span>

#include "config/object_types.hpp"

namespace pogosim {

std::span<ObjectType const> lamp_types();

/// All types of this simulator: what the loader of configurations takes.
ObjectTypes const& object_types();

}  // namespace pogosim
