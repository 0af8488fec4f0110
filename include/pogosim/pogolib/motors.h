// The motors. A power, once set, drives the robot until it is changed.
#ifndef POGOSIM_POGOLIB_MOTORS_H
#define POGOSIM_POGOLIB_MOTORS_H

typedef enum { motorR = 0, motorL = 1, motorB = 2 } motor_id;

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

/// Power of one motor (PWM, 0 to 1023; more counts as 1023). An unknown motor does nothing.
void pogobot_motor_power_set(motor_id motor, uint16_t value);
void pogobot_motor_set(motor_id motor, uint16_t value);

/// Direction bit of one motor, at once. Forward is 1 for the left motor and 0 for the right one, unless the stored
/// calibration says otherwise. An unknown motor does nothing.
void pogobot_motor_dir_set(motor_id motor, uint8_t value);

/// Direction bits now: bit 0 right, bit 1 left, bit 2 back.
uint32_t pogobot_motor_dir_current_status(void);

/// Directions in the robot's persistent memory, three bytes [right, left, back]. Return 0, or -1 for NULL.
int8_t pogobot_motor_dir_mem_get(uint8_t* p_directions);
int8_t pogobot_motor_dir_mem_set(uint8_t* p_directions);

/// Powers in the persistent memory, three values [right, left, back]. Return 0, or 255 for NULL.
uint8_t pogobot_motor_power_mem_get(uint16_t* p_powers);
uint8_t pogobot_motor_power_mem_set(uint16_t* p_powers);

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
