// A data column over time: the selected robot, the mean of the swarm and the band from its 10th to its 90th percentile.
#pragma once

#include "view/panels.hpp"

namespace pogosim {

/// Fills the panel that is open.
void draw_plot(PanelState& state);

}  // namespace pogosim
