// A window without a display: in place of a user, a test says what happens in it.
#pragma once

#include <functional>

#include "view/exchange.hpp"

namespace pogosim::testing {

/// What the window does, in its own thread, from its opening to its end; returns how it ends. Set it before the run.
using WindowScript = std::function<WindowEnd(WindowSetup const& setup, Exchange& exchange)>;
extern WindowScript window_script;

}  // namespace pogosim::testing
