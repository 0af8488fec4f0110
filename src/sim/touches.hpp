// What a user did to a run in the window, or a host between two steps.
#pragma once

#include <cstdint>
#include <string>

#include "world/world.hpp"

namespace pogosim {

class Touches {
public:
    /// An object was moved by hand. Moves of one object in a row, at most half a second of simulated time apart, count
    /// once: a hand moves it in many small steps.
    void add_move(std::uint32_t object, double time_s);

    /// A click that ran callback_robot_click.
    void add_click(double time_s);

    /// A robot or a lamp was set, or switched off or on.
    void add_switch(double time_s);

    bool any() const { return moves_ + clicks_ + switches_ > 0; }

    /// For the metadata: "3 times from t = 1.2300 s on: objects moved by hand". Empty for an untouched run.
    std::string text() const;

private:
    void begin(double time_s);

    int moves_ = 0;
    int clicks_ = 0;
    int switches_ = 0;
    double first_s_ = 0.0;
    std::uint32_t moved_object_ = kNone;  // by the last touch
    double last_move_s_ = 0.0;
};

}  // namespace pogosim
