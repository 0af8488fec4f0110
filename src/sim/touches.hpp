// A record of what a user did to a run in the window, or a host between two steps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>

#include "world/world.hpp"

namespace pogosim {

enum class Touch : std::uint8_t {
    move,       // of an object
    click,      // that ran callback_robot_click
    alive,      // a robot was switched off or on
    lamp,       // a lamp was set
    parameter,  // a variable of the program was set
    column,     // a column of the data file was set
    link        // a link was made or cut
};

class Touches {
public:
    void add(Touch kind, double time_s);

    /// Moves of one object in a row, at most half a second of simulated time apart, count once: a hand moves it in many
    /// small steps.
    void add_move(std::uint32_t object, double time_s);

    bool any() const { return total() > 0; }

    /// The text for the metadata: "3 times from t = 1.2300 s on: objects moved by hand". Empty for an untouched run.
    std::string text() const;

private:
    int total() const { return std::accumulate(count_.begin(), count_.end(), 0); }

    std::array<int, static_cast<std::size_t>(Touch::link) + 1> count_{};
    double first_s_ = 0.0;
    std::uint32_t moved_object_ = kNone;  // by the last touch
    double last_move_s_ = 0.0;
};

}  // namespace pogosim
