// What functions of the interface check when they are called.
#pragma once

#include <cstdio>

#include "device/arguments.hpp"
#include "process/crash_handler.hpp"
#include "robot/context.hpp"

namespace pogosim {

/// Does not return if no robot is running. `function`: its name, for the message.
inline void require_robot(char const* function) {
    if (context.controller == nullptr) [[unlikely]] {
        called_without_robot(function);
    }
}

/// Rejects a NULL pointer: exit code 2.
inline void require_argument(void const* argument, char const* function, char const* name) {
    if (argument == nullptr) [[unlikely]] {
        char what[128];
        std::snprintf(what, sizeof(what), "%s(): %s is NULL", function, name);
        refuse_user_code(what);
    }
}

// Warnings about values that functions of the interface cannot take as they are: once in a run for each function and
// kind of mistake. The headers say what happens to such values.

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
