// The main loop of a program: the same code on simulated and real robots (gnu99 there).
#include "pogobase.h"

#define ERROR_DISPLAY_MS 1000

POGO_PER_ROBOT uint32_t pogobot_ticks = 0;
POGO_PER_ROBOT uint8_t main_loop_hz = 60;
POGO_PER_ROBOT uint8_t max_nb_processed_msg_per_tick = 3;
POGO_PER_ROBOT uint8_t percent_msgs_sent_per_ticks = 20;
POGO_PER_ROBOT void (*msg_rx_fn)(message_t*) = NULL;
POGO_PER_ROBOT bool (*msg_tx_fn)(void) = NULL;
POGO_PER_ROBOT uint32_t nb_msgs_sent = 0;
POGO_PER_ROBOT uint32_t nb_msgs_recv = 0;
POGO_PER_ROBOT int8_t error_codes_led_idx = 3;
POGO_PER_ROBOT time_reference_t _global_timer;
POGO_PER_ROBOT time_reference_t timer_main_loop;
POGO_PER_ROBOT uint32_t _current_time_milliseconds = 0;
POGO_PER_ROBOT uint32_t _error_code_initial_time = 0;  // 0: no error is shown

#ifdef REAL_ROBOT
#define pogosim_let_time_pass()
#define pogosim_call_msg_tx_fn(send) send()
#define pogosim_take_time_of(function)
#define pogosim_take_time_of_tick(user_step)
#else
#include "pogosim/program.h"
// In the simulator, a program waits here that reads its clock again and again, or whose functions take time. It may go
// on in another thread, so no address of a thread-local variable is kept here; the timers' functions do not wait.
#endif

uint32_t current_time_milliseconds(void) {
    pogosim_let_time_pass();
    // Moves the origin by whole milliseconds, so that the rest is not lost and the stopwatch never overflows.
    int32_t const us = pogobot_stopwatch_get_elapsed_microseconds(&_global_timer);
    if (us >= 1000 || us <= -1000) {
        int32_t const ms = us / 1000;
        pogobot_stopwatch_offset_origin_microseconds(&_global_timer, ms * 1000);
        _current_time_milliseconds += (uint32_t)ms;
    }
    return _current_time_milliseconds;
}

static void show_on_error_led(uint8_t r, uint8_t g, uint8_t b) {
    if (error_codes_led_idx >= 0) {
        pogobot_led_setColors(r, g, b, (uint8_t)error_codes_led_idx);
    }
}

void display_led_error_code(error_code_t code) {
    uint8_t r, g, b;
    qualitative_colormap((uint8_t)code, &r, &g, &b);
    show_on_error_led(r, g, b);
    uint32_t const now = current_time_milliseconds();
    _error_code_initial_time = now > 0 ? now : 1;
}

static void send_message_by_chance(void) {
    if (msg_tx_fn && rand() % 100 < percent_msgs_sent_per_ticks && pogosim_call_msg_tx_fn(msg_tx_fn)) {
        nb_msgs_sent++;
    }
}

static void process_received_messages(void) {
    if (!msg_rx_fn) {
        return;
    }
    pogobot_infrared_update();
    for (uint8_t n = 0; msg_rx_fn && n < max_nb_processed_msg_per_tick && pogobot_infrared_message_available(); n++) {
        message_t message;
        void (*const receive)(message_t*) = msg_rx_fn;  // which it may change
        pogobot_infrared_recover_next_message(&message);
        receive(&message);
        pogosim_take_time_of((void (*)(void))receive);
        nb_msgs_recv++;
    }
    pogobot_infrared_clear_message_queue();
}

static void sleep_until_next_tick(void) {
    if (main_loop_hz == 0) {
        return;
    }
    int32_t const allowed_us = 1000000 / main_loop_hz;
    int32_t const elapsed_us = pogobot_stopwatch_get_elapsed_microseconds(&timer_main_loop);
    if (elapsed_us > allowed_us) {
        printf("[TIME] Error code: 0: tick took %ld ms; main_loop_hz allows %ld ms\n", (long)(elapsed_us / 1000),
               (long)(allowed_us / 1000));
        display_led_error_code(ERROR_TIME_OVERFLOW);
    } else {
        msleep((allowed_us - elapsed_us) / 1000);
    }
}

static void end_error_display(void) {
    if (_error_code_initial_time > 0 && current_time_milliseconds() - _error_code_initial_time >= ERROR_DISPLAY_MS) {
        show_on_error_led(0, 0, 0);
        _error_code_initial_time = 0;
    }
}

void pogo_main_loop_step(void (*user_step)(void)) {
    pogobot_stopwatch_reset(&timer_main_loop);
    if (user_step) {
        user_step();
    }
    pogosim_take_time_of_tick(user_step);
    send_message_by_chance();
    process_received_messages();
    sleep_until_next_tick();
    end_error_display();
    pogobot_ticks++;
}

#ifdef REAL_ROBOT

void clear_IR_buffers(void) {
    pogobot_infrared_update();
    pogobot_infrared_clear_message_queue();
}

void _pogobot_start(void (*user_init)(void), void (*user_step)(void)) {
    pogobot_stopwatch_reset(&_global_timer);
    pogobot_stopwatch_reset(&timer_main_loop);
    pogobot_ticks = 0;
    if (user_init) {
        user_init();
    }
#ifndef DISABLE_CLEARING_IR_BUFFERS_AT_INIT
    clear_IR_buffers();
#endif
    for (;;) {
        pogo_main_loop_step(user_step);
    }
}

#endif

static bool send_wall_message(void) {
    static char const text[] = "wall";
    pogobot_infrared_sendLongMessage_omniSpe((uint8_t*)text, (uint16_t)sizeof(text));
    return true;
}

void default_walls_user_init(void) {
    srand((unsigned)pogobot_helper_getRandSeed());
    pogobot_infrared_set_power(pogobot_infrared_emitter_power_twoThird);
    main_loop_hz = 10;
    max_nb_processed_msg_per_tick = 0;
    percent_msgs_sent_per_ticks = 75;
    msg_rx_fn = NULL;
    msg_tx_fn = send_wall_message;
    error_codes_led_idx = -1;
}

void default_walls_user_step(void) {}
