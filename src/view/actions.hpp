// What keys do in the window, and the help about them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace pogosim {

enum class Action {
    help,
    trails,
    slower,
    faster,
    links,
    lateral_leds,
    light_levels,
    time_and_scale_bar,
    panels,
    full_screen,
    screenshot,
    labels,
    velocities,
    heard,
    density,
    theme,
    follow,
    look_back,
    look_forward,
    look_at_now,
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
std::optional<Action> action_of(std::int32_t key, bool shift);

/// Keys, then the mouse.
std::span<Help const> help_lines();

}  // namespace pogosim
