/// @file
/// Photosensors and inertial measurement unit.
#ifndef POGOSIM_POGOLIB_SENSORS_H
#define POGOSIM_POGOLIB_SENSORS_H

/// Photosensors: back, front left, front right.
typedef enum { p_B = 0, p_FL = 1, p_FR = 2 } photosensor_id;

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

/// Light level at photosensor 0 (back), 1 (front left) or 2 (front right), sensor counts: 0 to 32767, with noise and
/// bias -32768 to 32767; on a real robot, and with `photosensors_bits: 10`, 0 to 1023. -1 for other numbers. Sensors
/// are on the rim, at 180, -40 and +40 degrees from the heading.
/// @range sensor_number: 0 to 2; returns sensor counts, 0 to 32767 without noise; 0 to 1023 with photosensors_bits: 10
int16_t pogobot_photosensors_read(uint8_t sensor_number);

/// Acceleration (m/s2: [0] to the right, [1] forward, [2] up) and angular velocity (rad/s; [2] counter-clockwise seen
/// from above), three floats each, not NULL. Clamped to +-156.9 m/s2 and +-34.9 rad/s like the real chip. Nothing
/// tilts, and there is no gravity unless `imu_gravity` says so (on a real robot, acc[2] is 9.8 at rest): acc[2],
/// gyro[0] and gyro[1] are 0 but for the noise that a configuration may add. Both are what the body did in the last
/// step, whatever its motors ask of it. The acceleration is the change of velocity between the last two ticks (0 at the
/// first), divided by the robot's time between them. With a `time_step` of 10 ms (the default), ticks of 16 ms are 10
/// or 20 ms apart, so in a steady turn it alternates around its mean; with a `time_step` of 8 or 16 ms it does not.
/// @range acc: m/s2, +-156.9; gyro: rad/s, +-34.9
void pogobot_imu_read(float* acc, float* gyro);

/// Temperature of the chip, degrees Celsius, -40 to 85; `arena_temperature` in the simulator, which `sensor_model:
/// robot` rounds to counts of the chip, 1/333.87 degrees.
/// @range returns degrees Celsius, -40 to 85
float pogobot_imu_readTemp(void);

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
