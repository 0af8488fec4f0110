/// @file
/// Magnetometer (LIS2MDL, robots of version 3).
#ifndef POGOSIM_POGOLIB_MAGNETOMETER_H
#define POGOSIM_POGOLIB_MAGNETOMETER_H

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

/// Looks for the magnetometer and sets it up; pogobot_init() has already done so. 1: it is there; 0: this object has
/// none (`magnetometer_enabled: false`, a pogobject, a pogowall or a membrane).
/// @range returns 1: found, 0: not
uint8_t magn_init(void);

/// Magnetic field along the three axes of the sensor, in counts of 1.5 mG, not calibrated. As the robot turns, (x, y)
/// describes an ellipse whose centre, axes and angle differ from robot to robot; see docs/magnetometer.md. Returns 0 if
/// it has read new data; 1 if it has not, then x, y and z keep their values: this object has no magnetometer, a pointer
/// is NULL (with a warning), or the time is over. With `magnetometer.timing: at_once` (the default) data are always
/// there; with `robot`, there are new data 50 times per second, and the robot waits for them for up to timeout_ms. 0
/// does not look for data at all on a robot: it returns 1.
/// @range x, y, z: counts, -32768 to 32767; timeout_ms: ms; returns 0: success, 1: no data
int magn_read_XYZ(int16_t* x, int16_t* y, int16_t* z, uint16_t timeout_ms);

///@{
/// Opens and closes the link to the chip of a real robot; does nothing in the simulator.
void magn_begin(void);
void magn_end(void);
///@}

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
