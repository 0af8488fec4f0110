// What keys do in the window, but for those of switches.hpp, and the help about all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace pogosim {

enum class Action {
    help,
    slower,
    faster,
    panels,
    full_screen,
    screenshot,
    follow,
    look_back,
    look_forward,
    look_at_newest,
    quit,
    pause,
    step,
    restart,
    restart_with_next_seed,
    pan_left,
    pan_right,
    pan_up,
    pan_down,
    zoom_in,
    zoom_out,
    reset_view,
};

/// A line of the help.
struct Help {
    char const* input;
    char const* effect;
};

/// The action of a key, SDL's SDL_Keycode, with or without Shift; letters are those of the keyboard's layout.
/// `is_repeated`: it has been held down for a while, which most keys ignore.
std::optional<Action> action_of(std::int32_t key, bool shift, bool is_repeated = false);

/// Keys, those of switches too, then the mouse.
std::vector<Help> help_lines();

}  // namespace pogosim
