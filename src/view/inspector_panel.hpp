// The panel with everything about the selected robot.
#pragma once

#include "render/inspection.hpp"

namespace pogosim {

void draw_inspector(Inspection const& robot, float scale);

}  // namespace pogosim
