// The panel about the selected robot.
#pragma once

#include "render/inspection.hpp"

namespace pogosim {

/// Fills the panel that is open.
void draw_inspector(Inspection const& robot);

}  // namespace pogosim
