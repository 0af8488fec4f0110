/// @file
/// The motors. A power, once set, drives the robot until it is changed. With powers L and R, a simulated robot drives
/// at `max_linear_speed` (L + R) / 2046 and turns clockwise at `max_angular_speed` (L - R) / 511.5, with the noise and
/// the bias of its category. Motors of walls, membranes, pogobjects and active objects do nothing.
#ifndef POGOSIM_POGOLIB_MOTORS_H
#define POGOSIM_POGOLIB_MOTORS_H

/// Motors: right, left and back. The back one moves nothing.
typedef enum { motorR = 0, motorL = 1, motorB = 2 } motor_id;

/// Some powers (PWM).
typedef enum {
    motorStop = 0,
    motorQuarter = 256,
    motorHalf = 512,
    motorThreeQuarter = 716,
    motorFull = 1023
} motor_range;

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

///@{
/// Power of one motor (PWM, 0 to 1023; more counts as 1023). An unknown motor does nothing. Both names do the same.
/// @range value: PWM, 0 to 1023
void pogobot_motor_power_set(motor_id motor, uint16_t value);
void pogobot_motor_set(motor_id motor, uint16_t value);
///@}

/// Sets the direction bit of one motor, 0 or 1 (more counts as 1), immediately. Forward is 1 for the left motor and 0
/// for the right one, unless the stored calibration says otherwise. An unknown motor does nothing.
/// @range value: 0 or 1
void pogobot_motor_dir_set(motor_id motor, uint8_t value);

/// Current direction bits: bit 0 right, bit 1 left, bit 2 back.
/// @range returns 0 to 7
uint32_t pogobot_motor_dir_current_status(void);

///@{
/// Reads or writes the directions in the robot's persistent memory: three bytes [right, left, back], {0, 1, 0} at the
/// start of a simulation. Returns 0, or -1 for NULL.
/// @range each of the three 0 or 1
int8_t pogobot_motor_dir_mem_get(uint8_t* p_directions);
int8_t pogobot_motor_dir_mem_set(uint8_t* p_directions);
///@}

///@{
/// Reads or writes the powers in the persistent memory: three values [right, left, back], 0 to 1023, {512, 512, 0} at
/// the start of a simulation. They have no effect until the program sets them. Returns 0, or 255 for NULL.
/// @range each of the three: PWM, 0 to 1023
uint8_t pogobot_motor_power_mem_get(uint16_t* p_powers);
uint8_t pogobot_motor_power_mem_set(uint16_t* p_powers);
///@}

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
