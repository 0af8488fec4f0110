// Preconditions of interface functions that act on a robot.
#pragma once

#include <cstdio>

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

}  // namespace pogosim
