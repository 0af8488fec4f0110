// pogolib/motors.h
#include <algorithm>
#include <cstring>

#include "device/motors.hpp"
#include "robot/context.hpp"
#include "robot/require_robot.hpp"
#include "robot/slip.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::kMotorCount;
using pogosim::note_slip;
using pogosim::require_robot;

namespace {

pogosim::Motors& own_motors() {
    return context.devices().motors[context.device];
}

bool is_motor(char const* function, motor_id motor) {
    bool const known = static_cast<int>(motor) >= 0 && static_cast<int>(motor) < static_cast<int>(kMotorCount);
    if (!known) [[unlikely]] {
        note_slip({function, "motor", "motorR (0), motorL (1) or motorB (2)", "nothing is set"},
                  static_cast<int>(motor));
    }
    return known;
}

/// A power that is negative as a 16-bit number was meant as a reversed direction.
void note_power(char const* function, std::uint16_t power) {
    if (power > INT16_MAX) {
        note_slip({function, "value", "0 to 1023 (motorFull)",
                   "powers are unsigned, so this one drives the motor at full power; to reverse it, use "
                   "pogobot_motor_dir_set and a positive power"},
                  static_cast<int>(static_cast<std::int16_t>(power)));
    } else {
        note_slip({function, "value", "0 to 1023 (motorFull)", "1023 is used"}, power);
    }
}

void set_power(char const* function, motor_id motor, std::uint16_t power) {
    require_robot(function);
    pogosim::note_call();
    if (is_motor(function, motor)) {
        if (power > motorFull) [[unlikely]] {
            note_power(function, power);
        }
        pogosim::set_motor_power(*context.world, context.device, motor, power);
    }
}

/// False, with a message, if the caller gave no place for the three values of the persistent memory.
bool has_place(char const* function, char const* argument, void const* place) {
    if (place == nullptr) [[unlikely]] {
        note_slip({function, argument, "the address of three values", "nothing is read or written"}, "NULL");
    }
    return place != nullptr;
}

/// Reports a value to be stored that is above what motors take.
template <class T>
void note_stored(char const* function, char const* argument, T const* values, T most, char const* expected) {
    T const* const wrong = std::find_if(values, values + kMotorCount, [most](T value) { return value > most; });
    if (wrong != values + kMotorCount) [[unlikely]] {
        note_slip({function, argument, expected, "it is stored as it is"}, *wrong);
    }
}

}  // namespace

void pogobot_motor_power_set(motor_id motor, uint16_t value) {
    set_power(__func__, motor, value);
}

void pogobot_motor_set(motor_id motor, uint16_t value) {
    set_power(__func__, motor, value);
}

void pogobot_motor_dir_set(motor_id motor, uint8_t value) {
    require_robot(__func__);
    if (is_motor(__func__, motor)) {
        if (value > 1) [[unlikely]] {
            note_slip({__func__, "value", "0 or 1", "1 is used"}, value);
        }
        pogosim::set_motor_direction(*context.world, context.device, motor, value);
    }
}

uint32_t pogobot_motor_dir_current_status() {
    require_robot(__func__);
    return pogosim::motor_directions(*context.world, context.device);
}

int8_t pogobot_motor_dir_mem_get(uint8_t* p_directions) {
    require_robot(__func__);
    if (!has_place(__func__, "p_directions", p_directions)) {
        return -1;
    }
    std::copy_n(own_motors().stored_direction.begin(), kMotorCount, p_directions);
    return 0;
}

int8_t pogobot_motor_dir_mem_set(uint8_t* p_directions) {
    require_robot(__func__);
    if (!has_place(__func__, "p_directions", p_directions)) {
        return -1;
    }
    note_stored<std::uint8_t>(__func__, "p_directions", p_directions, 1, "0 or 1 for each motor");
    std::copy_n(p_directions, kMotorCount, own_motors().stored_direction.begin());
    return 0;
}

uint8_t pogobot_motor_power_mem_get(uint16_t* p_powers) {
    require_robot(__func__);
    if (!has_place(__func__, "p_powers", p_powers)) {
        return UINT8_MAX;
    }
    std::copy_n(own_motors().stored_power.begin(), kMotorCount, p_powers);
    return 0;
}

uint8_t pogobot_motor_power_mem_set(uint16_t* p_powers) {
    require_robot(__func__);
    if (!has_place(__func__, "p_powers", p_powers)) {
        return UINT8_MAX;
    }
    note_stored<std::uint16_t>(__func__, "p_powers", p_powers, motorFull, "0 to 1023 (motorFull) for each motor");
    std::copy_n(p_powers, kMotorCount, own_motors().stored_power.begin());
    return 0;
}
