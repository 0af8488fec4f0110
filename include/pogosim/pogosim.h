// The interface layer: user data, the loop of a program and its globals. It is compiled for simulated and real robots
// alike; main_loop.c is its code. On a real robot it stands on the SDK (pogobot.h), here on pogosim/pogolib.h.
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

#define STRINGIFY_RAW(x) #x
#define STRINGIFY(x) STRINGIFY_RAW(x)
#define STATIC_STRCMP(a, b) __builtin_strcmp((a), (b))

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

// ---- Globals of the main loop. Each robot has its own. ----

/// Ticks executed so far; one more at the end of each tick.
extern POGO_PER_ROBOT uint32_t pogobot_ticks;
/// Ticks per second asked for. The sleep between ticks is cut to whole milliseconds, so 60 gives 62.5. 0: no sleep.
extern POGO_PER_ROBOT uint8_t main_loop_hz;
/// Messages handed to msg_rx_fn in one tick, at most; the others waiting then are dropped.
extern POGO_PER_ROBOT uint8_t max_nb_processed_msg_per_tick;
/// Chance (%) that msg_tx_fn is called in a tick.
extern POGO_PER_ROBOT uint8_t percent_msgs_sent_per_ticks;
/// Called with each received message; NULL: messages stay in the queue.
extern POGO_PER_ROBOT void (*msg_rx_fn)(message_t*);
/// Called to send a message; returns true when it sent one.
extern POGO_PER_ROBOT bool (*msg_tx_fn)(void);
/// Messages sent (msg_tx_fn said true) and received (msg_rx_fn called) so far.
extern POGO_PER_ROBOT uint32_t nb_msgs_sent;
extern POGO_PER_ROBOT uint32_t nb_msgs_recv;
/// LED that shows error codes; negative: none.
extern POGO_PER_ROBOT int8_t error_codes_led_idx;

// Stopwatches and times of the library itself.
extern POGO_PER_ROBOT time_reference_t _global_timer;
extern POGO_PER_ROBOT time_reference_t timer_main_loop;
extern POGO_PER_ROBOT uint32_t _current_time_milliseconds;
extern POGO_PER_ROBOT uint32_t _error_code_initial_time;

/// Milliseconds since this robot started.
uint32_t current_time_milliseconds(void);

typedef enum error_code_t {
    ERROR_TIME_OVERFLOW = 0,  ///< a tick took longer than 1 / main_loop_hz
    error_code_t_last_entry
} error_code_t;

/// Shows an error code on the LED error_codes_led_idx, in the colour qualitative_colormap(code), for a second.
void display_led_error_code(error_code_t code);

/// One tick of the main loop: user step, send, receive, sleep.
void pogo_main_loop_step(void (*user_step)(void));

// ---- Entry point ----

/// pogobot_start(user_init, user_step) or pogobot_start(user_init, user_step, "category"): called by main() once per
/// category of objects the program controls (default "robots"). On a real robot the call whose category is
/// ROBOT_CATEGORY never returns; in the simulator all return. user_step may be NULL.
#define pogobot_start(...) POGO_START_PICK(__VA_ARGS__, pogobot_start_3, pogobot_start_2, )(__VA_ARGS__)
#define POGO_START_PICK(init, step, category, chosen, ...) chosen
#define pogobot_start_2(init, step) pogobot_start_3(init, step, "robots")

#ifdef REAL_ROBOT

#ifndef ROBOT_CATEGORY
#define ROBOT_CATEGORY robots
#endif
/// Constant for the compiler, so that the controllers of other categories are not in the firmware.
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
/// Callbacks are the simulator's; here the function need not exist.
#define SET_CALLBACK(callback_name, fn)

#else

#define pogobot_start_3(init, step, category) _pogobot_start((init), (step), (category))
void _pogobot_start(void (*user_init)(void), void (*user_step)(void), char const* category);
/// Category of the object that runs this code, as in the configuration.
char const* get_current_robot_category(void);
bool current_robot_category_is(char const* category);

#endif

// ---- Default controller of active walls ----

/// pogobot_start(default_walls_user_init, default_walls_user_step, "walls"): sends the five bytes "wall\0" as a long
/// message in all directions, 7.5 times a second.
void default_walls_user_init(void);
void default_walls_user_step(void);

POGO_END_API
#ifdef __cplusplus
}
#endif

#ifndef REAL_ROBOT
#include "pogosim/simulation.h"
#endif

#endif
