// Handles a display that is lost while a window is open. Xlib would end the program; the run must go on.
#pragma once

#include <csetjmp>

namespace pogosim {

/// From now on a lost connection to the X server jumps to `point`, in the thread that talks to the server. Nothing of
/// SDL may be called afterwards. Call it before SDL connects to the server. Does nothing without X.
void jump_when_display_is_lost(sigjmp_buf& point);

}  // namespace pogosim
