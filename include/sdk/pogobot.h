/// @file
/// The header of the robots' SDK, for programs that were written for the robots alone: `main()` does not return, and
/// variables are globals. Compiled with this one, such a program runs in the simulator as it is; each simulated robot has
/// its own variables and its own `main()`, which may wait in the middle.
///
///     cc main.c -o prog $(pkg-config --cflags --libs pogosim-sdk)
///
/// What belongs to the simulator alone (columns of the data file, values from the configuration) is in pogosim/simulation.h,
/// to be included between `#ifdef SIMULATOR` and `#endif`. Registers of the hardware are not simulated.
#ifndef POGOBOT_H
#define POGOBOT_H

#ifndef POGOBASE_H
// Variables of the simulator's main loop, which such a program does not have, but may have its own of the same name.
#define pogobot_ticks program_pogobot_ticks
#define main_loop_hz program_main_loop_hz
#define max_nb_processed_msg_per_tick program_max_nb_processed_msg_per_tick
#define percent_msgs_sent_per_ticks program_percent_msgs_sent_per_ticks
#define msg_rx_fn program_msg_rx_fn
#define msg_tx_fn program_msg_tx_fn
#define nb_msgs_sent program_nb_msgs_sent
#define nb_msgs_recv program_nb_msgs_recv
#define error_codes_led_idx program_error_codes_led_idx
#define _global_timer program__global_timer
#define timer_main_loop program_timer_main_loop
#define _current_time_milliseconds program__current_time_milliseconds
#define _error_code_initial_time program__error_code_initial_time
#define mydata program_mydata

#define POGOSIM_FOR_SDK
#endif

#include "pogosim/pogolib.h"

#ifdef POGOSIM_FOR_SDK
#ifdef __cplusplus
extern "C" {
#endif
// Tells the simulator how to run the program.
extern char const pogosim_is_for_sdk __attribute__((weak));
char const pogosim_is_for_sdk = 1;
#ifdef __cplusplus
}
#endif
#endif

#endif
