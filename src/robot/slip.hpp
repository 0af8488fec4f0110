// Warnings about values that functions of the interface cannot take as they are: once in a run for each function and
// kind of mistake. The headers say what happens to such values.
#pragma once

#include <string_view>

#include "robot/context.hpp"

namespace pogosim {

/// All are literals.
struct Slip {
    std::string_view function;  // "pogobot_motor_set"; empty: a variable of the main loop
    std::string_view argument;  // "value", or the variable
    std::string_view expected;  // "0 to 1023 (motorFull)"
    std::string_view outcome;   // "1023 is used"
};

/// To be called where something is wrong: it costs nothing elsewhere.
template <class Value>
[[gnu::cold, gnu::noinline]] void note_slip(Slip const& slip, Value const& value) {
    if (context.services != nullptr) {  // else a thread of the program's own has called it
        context.services->warn_once_of({.text = slip.outcome, .function = slip.function, .argument = slip.argument},
                                       "{}{}{} is {}, expected {}; {}", slip.function,
                                       slip.function.empty() ? "" : "(): ", slip.argument, value, slip.expected,
                                       slip.outcome);
    }
}

}  // namespace pogosim
