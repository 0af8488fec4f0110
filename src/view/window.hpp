// The window: shows the latest moment of a run, and turns keys and the mouse into commands.
#pragma once

#include "view/exchange.hpp"

namespace pogosim {

/// Opens the window and runs it until it is closed, in the thread that calls it.
void show_window(WindowSetup const& setup, Exchange& exchange);

}  // namespace pogosim
