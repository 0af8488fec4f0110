// Warnings about values that functions of the interface cannot take as they are: once in a run for each function and
// kind of mistake. The headers say what happens to such values.
#pragma once

#include "device/arguments.hpp"
#include "robot/context.hpp"

namespace pogosim {

/// To be called where something is wrong: it costs nothing elsewhere.
template <class Value>
[[gnu::cold, gnu::noinline]] void note_slip(Slip const& slip, Value const& value) {
    if (context.services != nullptr) {  // else a thread of the program's own has called it
        context.services->warn_once_of({.text = slip.outcome, .function = slip.function, .argument = slip.argument},
                                       "{}", slip_text(slip, value));
    }
}

/// Notes wrong arguments of a function, see device/arguments.hpp.
struct NoteSlip {
    char const* function;

    template <class Value>
    void operator()(WrongArgument const& wrong, Value const& value) const {
        note_slip({function, wrong.name, wrong.expected, wrong.outcome}, value);
    }
};

/// The model of the running robot; in a callback of the whole run, one that has every part.
inline RobotModel const& own_model() {
    static RobotModel const whole;
    return context.has_robot() ? context.spec().model : whole;
}

}  // namespace pogosim
