// What an entry of `links` asks of the objects that it links.
#pragma once

#include "config/scenario.hpp"

namespace pogosim {

/// Throws KeyError if the objects of the scenario cannot be linked like that.
void check_link(Scenario const& scenario, LinkConfig const& link);

}  // namespace pogosim
