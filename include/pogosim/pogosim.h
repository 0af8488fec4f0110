/// @file
/// The interface layer: user data, the main loop and its globals. It is compiled for both simulated and real robots;
/// its code is main_loop.c. On a real robot it uses the SDK (pogobot.h), in the simulator pogosim/pogolib.h.
#ifndef POGOSIM_POGOSIM_H
#define POGOSIM_POGOSIM_H

#ifdef REAL_ROBOT
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#include "pogobot.h"
}
#else
#include "pogobot.h"
#endif
#define POGO_PER_ROBOT
#define POGO_BEGIN_API
#define POGO_END_API
#else
#include "pogosim/pogolib.h"
#endif

#include "pogosim/colormaps.h"
#include "pogosim/shared_state.h"
#include "pogosim/userdata.h"

/// The text of `x`.
#define STRINGIFY_RAW(x) #x
/// The text of what the macro `x` expands to.
#define STRINGIFY(x) STRINGIFY_RAW(x)
/// strcmp() that the compiler evaluates if both strings are constants.
#define STATIC_STRCMP(a, b) __builtin_strcmp((a), (b))

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

// ---- Globals of the main loop. Each robot has its own. ----

/// Number of ticks executed; incremented at the end of each tick.
/// @range from 0
extern POGO_PER_ROBOT uint32_t pogobot_ticks;
/// Requested ticks per second, initially 60; 0: a tick in every `time_step`, without a sleep.
/// The sleep between ticks is truncated to milliseconds, so 60 gives 62.5.
/// @range Hz, 0 to 255; initially 60
extern POGO_PER_ROBOT uint8_t main_loop_hz;
/// Maximum number of messages passed to msg_rx_fn per tick, initially 3; any others waiting are dropped.
/// @range 0 to 255; initially 3
extern POGO_PER_ROBOT uint8_t max_nb_processed_msg_per_tick;
/// Chance (0 to 100 %) that msg_tx_fn is called in a tick, initially 20. Reception also depends on it.
/// @range %, 0 to 100; initially 20
extern POGO_PER_ROBOT uint8_t percent_msgs_sent_per_ticks;
/// Called with each received message, after the step; NULL (initially): messages stay in the queue.
extern POGO_PER_ROBOT void (*msg_rx_fn)(message_t*);
/// Called at random after the step to send a message; returns true if it sent one. NULL (initially): none.
extern POGO_PER_ROBOT bool (*msg_tx_fn)(void);
///@{
/// Messages sent (msg_tx_fn returned true) and received (msg_rx_fn was called) so far.
/// @range from 0
extern POGO_PER_ROBOT uint32_t nb_msgs_sent;
extern POGO_PER_ROBOT uint32_t nb_msgs_recv;
///@}
/// LED that shows error codes, 0 to 4, initially 3; negative: none.
/// @range 0 to 4, negative: none; initially 3
extern POGO_PER_ROBOT int8_t error_codes_led_idx;

// Stopwatches and times of the library itself.
extern POGO_PER_ROBOT time_reference_t _global_timer;
extern POGO_PER_ROBOT time_reference_t timer_main_loop;
extern POGO_PER_ROBOT uint32_t _current_time_milliseconds;
extern POGO_PER_ROBOT uint32_t _error_code_initial_time;

/// Milliseconds since this robot started, by its own clock.
/// @range returns ms, from 0
uint32_t current_time_milliseconds(void);

/// Error codes that a robot shows on its error LED.
typedef enum error_code_t {
    ERROR_TIME_OVERFLOW = 0,  ///< a tick took longer than 1 / main_loop_hz
    error_code_t_last_entry   ///< number of codes
} error_code_t;

/// Shows an error code on the LED error_codes_led_idx, in the colour qualitative_colormap(code), for a second.
void display_led_error_code(error_code_t code);

/// One tick of the main loop: user step (NULL: none), send, receive, sleep. Programs do not need to call it.
void pogo_main_loop_step(void (*user_step)(void));

// ---- Entry point ----

/// Says which functions control the objects of a category: `pogobot_start(user_init, user_step)` or
/// `pogobot_start(user_init, user_step, "category")`, called by main() once per category of objects the program
/// controls (default "robots"). user_init runs once, user_step in each tick; both may be NULL. On a real robot, the
/// call whose category is `ROBOT_CATEGORY` (an option of `make bin`) never returns; in the simulator all calls return,
/// and objects of a category without a call do nothing, with a warning.
#define pogobot_start(...) POGO_START_PICK(__VA_ARGS__, pogobot_start_3, pogobot_start_2, )(__VA_ARGS__)
#define POGO_START_PICK(init, step, category, chosen, ...) chosen
#define pogobot_start_2(init, step) pogobot_start_3(init, step, "robots")

#ifdef REAL_ROBOT

#ifndef ROBOT_CATEGORY
#define ROBOT_CATEGORY robots
#endif
/// A compile-time constant, so that the controllers of other categories are not in the firmware.
#define get_current_robot_category() STRINGIFY(ROBOT_CATEGORY)
#define current_robot_category_is(name) (STATIC_STRCMP(STRINGIFY(ROBOT_CATEGORY), (name)) == 0)
#define pogobot_start_3(init, step, category)    \
    do {                                         \
        if (current_robot_category_is(category)) \
            _pogobot_start((init), (step));      \
    } while (0)
void _pogobot_start(void (*user_init)(void), void (*user_step)(void));
void user_init(void);
void user_step(void);
/// Empties the hardware FIFOs of the four infrared receivers.
void clear_IR_buffers(void);
/// Callbacks exist in the simulator only; on a robot, the function need not exist.
#define SET_CALLBACK(callback_name, fn)

#else

#define pogobot_start_3(init, step, category) _pogobot_start((init), (step), (category))
void _pogobot_start(void (*user_init)(void), void (*user_step)(void), char const* category);
/// Category of the object that runs this code, as in the configuration; "__system" in callback_global_step.
char const* get_current_robot_category(void);
/// Whether the object has this category; false for NULL. A constant on a real robot, like get_current_robot_category().
bool current_robot_category_is(char const* category);

#endif

// ---- Default controller of active walls ----

///@{
/// Active walls that send the five bytes "wall\0" as a long message in all directions, 7.5 times per second:
/// `pogobot_start(default_walls_user_init, default_walls_user_step, "walls")`.
void default_walls_user_init(void);
void default_walls_user_step(void);
///@}

POGO_END_API
#ifdef __cplusplus
}
#endif

#ifndef REAL_ROBOT
#include "pogosim/simulation.h"
#include "pogosim/world.h"
#endif

#endif
