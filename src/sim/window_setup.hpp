// How the window of a run begins.
#pragma once

#include <string>

#include "config/scenario.hpp"
#include "view/messages.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Sets all but the scenery, the seed and the place, which the run knows.
WindowSetup window_setup(Scenario const& scenario, World const& world, std::string const& program_name);

}  // namespace pogosim
