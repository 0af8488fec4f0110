/// @file
/// Stopwatches, timers and sleeping, in microseconds of the robot's own clock. The clock stops while user code runs and
/// advances when the robot sleeps. Loops that wait end nevertheless: after a thousand calls of the library in a tick,
/// each further one that reads the clock or a sensor, looks for messages, sends, sets a motor or an LED, or sleeps for
/// no time takes ten microseconds. Differences are clamped to the range of int32_t (35 minutes); on a real robot they
/// wrap around after about 107 s.
#ifndef POGOSIM_POGOLIB_TIMERS_H
#define POGOSIM_POGOLIB_TIMERS_H

/// A point in time. Declare, embed, copy and pass it by address; its fields are private to the library.
typedef struct time_reference_t {
    uint32_t hardware_value_at_time_origin;  ///< counter of the robot's clock
#ifndef REAL_ROBOT
    int64_t origin_us;  ///< us since the robot's start; simulator only
#endif
} time_reference_t;

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

/// Starts a stopwatch: origin = now.
void pogobot_stopwatch_reset(time_reference_t* stopwatch);
/// Time since the origin, us.
/// @range returns us, -2^31 to 2^31 - 1
int32_t pogobot_stopwatch_get_elapsed_microseconds(time_reference_t* stopwatch);
/// Time since the origin, us; then resets the origin to now.
/// @range returns us, -2^31 to 2^31 - 1
int32_t pogobot_stopwatch_lap(time_reference_t* stopwatch);
/// Moves the origin: a positive offset makes the elapsed time smaller.
void pogobot_stopwatch_offset_origin_microseconds(time_reference_t* stopwatch, int32_t microseconds_offset);

/// Starts a timer that expires after this many microseconds.
void pogobot_timer_init(time_reference_t* timer, int32_t microseconds_to_go);
/// Time left, us; negative once it has expired.
/// @range returns us, -2^31 to 2^31 - 1
int32_t pogobot_timer_get_remaining_microseconds(time_reference_t* timer);
/// True if the time left is negative.
bool pogobot_timer_has_expired(time_reference_t* timer);
/// Sleeps for the time left, if any.
void pogobot_timer_wait_for_expiry(time_reference_t* timer);
/// Moves the expiry by the offset: re-arms a periodic timer without drift.
void pogobot_timer_offset_origin_microseconds(time_reference_t* timer, int32_t microseconds_offset);

/// Sleeps for this time: the robot's program goes on in the first step of the simulation in which it is over. In
/// user_init and in callbacks, the robot's clock is moved on, and the program goes on at once. Zero and negative values
/// take no time.
void msleep(int milliseconds);

/// The same in microseconds. Declared as in <unistd.h>, which may be included, too; returns 0.
/// @range taken as an int, as on the robot
#ifdef REAL_ROBOT
int usleep(unsigned long microseconds);  // as in picolibc
#else
int usleep(unsigned microseconds);
#endif
/// The same in seconds. Declared as in <unistd.h>, which may be included, too; returns 0.
/// @range taken as an int, as on the robot
unsigned sleep(unsigned seconds);

/// Initialises the clock of a real robot; does nothing in the simulator.
void pli_timer_sleep_stopwatch_init(void);

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
