// The panel with everything about the selected robot.
#pragma once

#include "render/inspection.hpp"

namespace pogosim {

/// `in_its_corner`: top right, else where the user has put it.
void draw_inspector(Inspection const& robot, float scale, bool in_its_corner);

}  // namespace pogosim
