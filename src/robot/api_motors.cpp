// pogolib/motors.h
#include <algorithm>
#include <cstring>

#include "robot/context.hpp"
#include "robot/require_robot.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::kMotorCount;
using pogosim::require_robot;

namespace {

bool is_motor(motor_id motor) {
    bool const known = static_cast<int>(motor) >= 0 && static_cast<int>(motor) < kMotorCount;
    if (!known) {
        context.services->warn_once("no motor {}; nothing set (valid: motorL, motorR, motorB)",
                                    static_cast<int>(motor));
    }
    return known;
}

/// Powers above motorFull count as that, but what is negative in 16 bits was meant otherwise.
void warn_if_negative(std::uint16_t power) {
    if (power > INT16_MAX) {
        context.services->warn_once(
            "pogobot_motor_set was called with {}: powers are unsigned (0 to {}), so this one becomes {} and drives "
            "the motor at full power; to reverse it, use pogobot_motor_dir_set and a positive power",
            static_cast<int>(static_cast<std::int16_t>(power)), static_cast<int>(motorFull), power);
    }
}

}  // namespace

void pogobot_motor_power_set(motor_id motor, uint16_t value) {
    require_robot(__func__);
    pogosim::note_call();
    if (is_motor(motor)) {
        warn_if_negative(value);
        context.controller->motors.power[motor] = std::min<uint16_t>(value, motorFull);
        context.controller->motors.driven = true;
    }
}

void pogobot_motor_set(motor_id motor, uint16_t value) {
    require_robot(__func__);
    pogobot_motor_power_set(motor, value);
}

void pogobot_motor_dir_set(motor_id motor, uint8_t value) {
    require_robot(__func__);
    if (is_motor(motor)) {
        context.controller->motors.direction[motor] = value != 0 ? 1 : 0;
        context.controller->motors.driven = true;
    }
}

uint32_t pogobot_motor_dir_current_status() {
    require_robot(__func__);
    auto const& direction = context.controller->motors.direction;
    return static_cast<uint32_t>(direction[motorR] | (direction[motorL] << 1) | (direction[motorB] << 2));
}

int8_t pogobot_motor_dir_mem_get(uint8_t* p_directions) {
    require_robot(__func__);
    if (p_directions == nullptr) {
        return -1;
    }
    std::copy_n(context.controller->motors.stored_direction.begin(), kMotorCount, p_directions);
    return 0;
}

int8_t pogobot_motor_dir_mem_set(uint8_t* p_directions) {
    require_robot(__func__);
    if (p_directions == nullptr) {
        return -1;
    }
    std::copy_n(p_directions, kMotorCount, context.controller->motors.stored_direction.begin());
    return 0;
}

uint8_t pogobot_motor_power_mem_get(uint16_t* p_powers) {
    require_robot(__func__);
    if (p_powers == nullptr) {
        return UINT8_MAX;
    }
    std::copy_n(context.controller->motors.stored_power.begin(), kMotorCount, p_powers);
    return 0;
}

uint8_t pogobot_motor_power_mem_set(uint16_t* p_powers) {
    require_robot(__func__);
    if (p_powers == nullptr) {
        return UINT8_MAX;
    }
    std::copy_n(p_powers, kMotorCount, context.controller->motors.stored_power.begin());
    return 0;
}
