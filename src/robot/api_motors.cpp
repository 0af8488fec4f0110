// pogolib/motors.h
#include <algorithm>
#include <cstring>

#include "robot/context.hpp"
#include "robot/require_robot.hpp"

using pogosim::context;
using pogosim::kMotorCount;
using pogosim::require_robot;

namespace {

bool is_motor(motor_id motor) {
    return static_cast<int>(motor) >= 0 && static_cast<int>(motor) < kMotorCount;
}

}  // namespace

void pogobot_motor_power_set(motor_id motor, uint16_t value) {
    require_robot(__func__);
    if (is_motor(motor)) {
        context.computer->motors.power[motor] = std::min<uint16_t>(value, motorFull);
        context.computer->motors.driven = true;
    }
}

void pogobot_motor_set(motor_id motor, uint16_t value) {
    require_robot(__func__);
    pogobot_motor_power_set(motor, value);
}

void pogobot_motor_dir_set(motor_id motor, uint8_t value) {
    require_robot(__func__);
    if (is_motor(motor)) {
        context.computer->motors.direction[motor] = value != 0 ? 1 : 0;
        context.computer->motors.driven = true;
    }
}

uint32_t pogobot_motor_dir_current_status() {
    require_robot(__func__);
    auto const& direction = context.computer->motors.direction;
    return static_cast<uint32_t>(direction[motorR] | (direction[motorL] << 1) | (direction[motorB] << 2));
}

int8_t pogobot_motor_dir_mem_get(uint8_t* p_directions) {
    require_robot(__func__);
    if (p_directions == nullptr) {
        return -1;
    }
    std::copy_n(context.computer->motors.stored_direction.begin(), kMotorCount, p_directions);
    return 0;
}

int8_t pogobot_motor_dir_mem_set(uint8_t* p_directions) {
    require_robot(__func__);
    if (p_directions == nullptr) {
        return -1;
    }
    std::copy_n(p_directions, kMotorCount, context.computer->motors.stored_direction.begin());
    return 0;
}

uint8_t pogobot_motor_power_mem_get(uint16_t* p_powers) {
    require_robot(__func__);
    if (p_powers == nullptr) {
        return UINT8_MAX;
    }
    std::copy_n(context.computer->motors.stored_power.begin(), kMotorCount, p_powers);
    return 0;
}

uint8_t pogobot_motor_power_mem_set(uint16_t* p_powers) {
    require_robot(__func__);
    if (p_powers == nullptr) {
        return UINT8_MAX;
    }
    std::copy_n(p_powers, kMotorCount, context.computer->motors.stored_power.begin());
    return 0;
}
