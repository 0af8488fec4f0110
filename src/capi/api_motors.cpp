// pogolib/motors.h
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include "device/motors.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::kMotorCount;
using pogosim::note_slip;
using pogosim::NoteSlip;
using pogosim::require_robot;

namespace {

pogosim::Motors& own_motors() {
    return context.devices().motors[context.device];
}

void set_power(char const* function, motor_id motor, std::uint16_t power) {
    require_robot(function);
    pogosim::note_call();
    if (pogosim::is_motor(motor, NoteSlip{function})) {
        pogosim::check_power(power, NoteSlip{function});
        pogosim::check_motor_is_there(pogosim::own_model(), motor, power, NoteSlip{function});
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

}  // namespace

void pogobot_motor_power_set(motor_id motor, uint16_t value) {
    set_power(__func__, motor, value);
}

void pogobot_motor_set(motor_id motor, uint16_t value) {
    set_power(__func__, motor, value);
}

void pogobot_motor_dir_set(motor_id motor, uint8_t value) {
    require_robot(__func__);
    if (pogosim::is_motor(motor, NoteSlip{__func__})) {
        pogosim::check_direction(value, NoteSlip{__func__});
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
    pogosim::check_stored(std::span<std::uint8_t const>(p_directions, kMotorCount), NoteSlip{__func__});
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
    pogosim::check_stored(std::span<std::uint16_t const>(p_powers, kMotorCount), NoteSlip{__func__});
    std::copy_n(p_powers, kMotorCount, own_motors().stored_power.begin());
    return 0;
}
