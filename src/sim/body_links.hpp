// Links between bodies, for pictures.
#pragma once

#include <vector>

#include "render/snapshot.hpp"
#include "world/world.hpp"

namespace pogosim {

/// The links that hold, of categories that are drawn. `from_mm` is in the box of a periodic arena.
std::vector<BodyLink> drawn_links(World const& world);

}  // namespace pogosim
