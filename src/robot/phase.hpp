// Which of a program's functions runs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pogosim {

enum class Phase : std::uint8_t {
    none,
    construct_static_objects,
    construct_user_data,
    main,
    global_setup,
    user_init,
    create_data_schema,
    global_step,
    user_step,
    export_data,
    robot_click,
    robot_end,
    last_line
};

/// For messages: "user_step". Safe in signal handlers.
constexpr char const* name_of(Phase phase) {
    constexpr std::array kNames{"",
                                "a constructor of static objects",
                                "constructor of USERDATA",
                                "main",
                                "callback_global_setup",
                                "user_init",
                                "callback_create_data_schema",
                                "callback_global_step",
                                "user_step",
                                "export_data",
                                "robot_click",
                                "robot_end",
                                "the end"};
    static_assert(kNames.size() == static_cast<std::size_t>(Phase::last_line) + 1);
    return kNames[static_cast<std::size_t>(phase)];
}

/// Whether robots tick in this phase; before pogobot_start(), they do not.
constexpr bool has_ticks(Phase phase) {
    return phase != Phase::construct_static_objects && phase != Phase::construct_user_data && phase != Phase::main;
}

}  // namespace pogosim
