// What the user switches on and off in the picture, by a key or in the section "View" of the panel: a row for each.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "render/painter.hpp"

namespace pogosim {

/// One that is off or on is a choice between 0 and 1.
struct Switch {
    std::int32_t key = 0;           // SDL's SDL_Keycode; 0: it has none
    char const* key_name = "";      // in the help
    char const* effect = "";        // in the help
    char const* label = nullptr;    // in the panel; null: the panel shows it in another way
    char const* choices = nullptr;  // of more than two: their names, each ended by a zero, and one more zero
    bool is_beside = false;         // in the panel, on the line of the one before
    int (*get)(ViewOptions const& options) = nullptr;
    void (*set)(ViewOptions& options, int choice) = nullptr;

    int choice_count() const;

    /// Chooses the next one, and after the last one the first.
    void press(ViewOptions& options) const;
};

// As they stand in the panel, which has something else between these groups.

/// What is drawn of the arena and of robots.
std::span<Switch const> layer_switches();

/// What is written and drawn about robots.
std::span<Switch const> mark_switches();

std::span<Switch const> colour_switches();

/// All of them, in this order.
inline auto all_switches() {
    return std::array{layer_switches(), mark_switches(), colour_switches()};
}

/// The switch of a key; null: there is none.
Switch const* switch_of(std::int32_t key);

}  // namespace pogosim
