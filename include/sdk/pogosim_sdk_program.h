// Makes the program that includes pogobot.h one for the robots' SDK.
#ifndef POGOSIM_SDK_PROGRAM_H
#define POGOSIM_SDK_PROGRAM_H

#define POGOSIM_FOR_SDK

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

#ifdef __cplusplus
extern "C" {
#endif
// Tells the simulator how to run it.
extern char const pogosim_is_for_sdk __attribute__((weak));
char const pogosim_is_for_sdk = 1;
#ifdef __cplusplus
}
#endif

#endif
