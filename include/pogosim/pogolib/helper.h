/// @file
/// Start-up, identity and battery.
#ifndef POGOSIM_POGOLIB_HELPER_H
#define POGOSIM_POGOLIB_HELPER_H

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

/// Initialises the hardware of a real robot; does nothing in the simulator.
void pogobot_init(void);

/// Identifier of this robot: 0, 1, 2, ... in the order of the configuration; 65535, 65534, ... for walls and membranes;
/// 0 in callback_global_step. Among more than 65536 of them, ids repeat. A real robot has the number in its memory.
/// @range returns 0 to 65535
uint16_t pogobot_helper_getid(void);

/// A seed for srand(), any int16_t. The first one that a robot requests differs for every robot of a run and depends
/// only on the seed of the run and the robot. rand() without srand() also differs between simulated robots.
/// @range returns -32768 to 32767
int16_t pogobot_helper_getRandSeed(void);

/// Prints the version of the SDK, #POGOLIB_RELEASE_VERSION.
void pogobot_helper_print_version(void);

/// Battery voltage, mV. A simulated battery is always full, 4200, unless the configuration gives the robot a `battery`
/// that empties: down to 3000, and then the robot is switched off.
/// @range returns mV, up to 32767
int16_t pogobot_battery_voltage_read(void);

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
