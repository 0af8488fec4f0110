// The window of a run, in a module of its own that is loaded only now: a run without a window needs nothing of SDL.
#pragma once

#include <memory>
#include <string>
#include <thread>

#include "view/exchange.hpp"

namespace pogosim {

/// Whether a display is named, on which a window could open.
bool has_display();

/// An open window and its thread.
class OpenWindow {
public:
    /// Opens a window, and waits until it is there. Throws std::runtime_error, with the reason why there is none.
    explicit OpenWindow(WindowSetup const& setup);

    /// Closes the window. One that does not answer, as when its display hangs, is left behind.
    ~OpenWindow();

    OpenWindow(OpenWindow const&) = delete;
    OpenWindow& operator=(OpenWindow const&) = delete;

    Exchange& exchange() { return *exchange_; }

private:
    std::shared_ptr<Exchange> exchange_;
    std::thread thread_;
};

/// True when a window, or what its display has left, is still there: the program must end without destructors.
bool window_was_left_behind();

}  // namespace pogosim
