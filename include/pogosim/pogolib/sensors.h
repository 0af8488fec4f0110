// Photosensors and inertial measurement unit.
#ifndef POGOSIM_POGOLIB_SENSORS_H
#define POGOSIM_POGOLIB_SENSORS_H

typedef enum { p_B = 0, p_FL = 1, p_FR = 2 } photosensor_id;

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

/// Light level at photosensor 0 (back), 1 (front left) or 2 (front right), 0 to 32767 before noise and bias. -1 for
/// other numbers.
int16_t pogobot_photosensors_read(uint8_t sensor_number);

/// Acceleration (m/s2: [0] to the right, [1] forward, [2] up; the mean between the last two ticks) and angular velocity
/// (rad/s; [2] counter-clockwise seen from above), three floats each. Clamped to +-156.9 m/s2 and +-34.9 rad/s as the
/// real chip.
void pogobot_imu_read(float* acc, float* gyro);

/// Temperature of the chip, degrees Celsius, -40 to 85.
float pogobot_imu_readTemp(void);

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
