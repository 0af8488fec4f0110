// A program for the robots alone: an endless main(), variables of its own, and the SDK's functions.
#include "pogobot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifdef SIMULATOR
#include "pogosim/simulation.h"
#endif

#define LOOP_HZ 50

typedef enum { WAITING, MOVING } state_t;

// Names that the simulator's main loop has, too.
uint32_t pogobot_ticks = 0;
uint8_t main_loop_hz = LOOP_HZ;
float mydata[4] = {1.0f, 2.0f};

static uint32_t heard[256];
static uint32_t heard_in_all;
static uint32_t sent;
static state_t state;
static const char* const names[] = {"waiting", "moving"};
static const char* name = "waiting";
int32_t gain = 7;

void hsv_to_rgb(void) {
    mydata[1] += 1.0f;
}

int current_time_milliseconds(time_reference_t* since) {
    return pogobot_stopwatch_get_elapsed_microseconds(since) / 1000;
}

static uint32_t count_calls(void) {
    static uint32_t calls;
    return ++calls;
}

static void receive(void) {
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t message;
        pogobot_infrared_recover_next_message(&message);
        heard[message.payload[0]]++;
        heard_in_all++;
    }
}

static void send(void) {
    uint8_t const id = (uint8_t)pogobot_helper_getid();
    uint8_t payload[2] = {id, 0};
    if (rand() % 100 < 20) {
        pogobot_infrared_sendShortMessage_omni(payload, sizeof(payload));
        sent++;
    }
}

#ifdef SIMULATOR
static void create_data_schema(void) {
    data_add_column_int32("ticks");
    data_add_column_int32("calls");
    data_add_column_int32("sent");
    data_add_column_int32("heard");
    data_add_column_int32("heard_of_itself");
    data_add_column_int32("gain");
    data_add_column_string("state");
}

static void export_data(void) {
    data_set_value_int32("ticks", (int32_t)pogobot_ticks);
    data_set_value_int32("calls", (int32_t)mydata[1]);
    data_set_value_int32("sent", (int32_t)sent);
    data_set_value_int32("heard", (int32_t)heard_in_all);
    data_set_value_int32("heard_of_itself", (int32_t)heard[pogobot_helper_getid()]);
    data_set_value_int32("gain", gain);
    data_set_value_string("state", name);
}
#endif

int main(void) {
    pogobot_init();
#ifdef SIMULATOR
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    init_from_configuration(gain);
#endif
    srand((unsigned)pogobot_helper_getRandSeed());
    time_reference_t start, step;
    pogobot_stopwatch_reset(&start);
    while (1) {
        pogobot_stopwatch_reset(&step);
        receive();
        send();
        hsv_to_rgb();
        if (count_calls() != pogobot_ticks + 1) {
            printf("another robot has called this\n");
        }
        state = current_time_milliseconds(&start) < 1000 ? WAITING : MOVING;
        if (state == MOVING && name != names[MOVING]) {
            printf("%u moves after %d ms\n", pogobot_helper_getid(), current_time_milliseconds(&start));
            pogobot_motor_set(motorL, motorHalf);
            pogobot_motor_set(motorR, motorHalf);
            pogobot_led_setColor(0, 25, 0);
        }
        name = names[state];
        pogobot_ticks++;
        int32_t const elapsed_us = pogobot_stopwatch_get_elapsed_microseconds(&step);
        if (elapsed_us < 1000000 / main_loop_hz) {
            msleep((1000000 / main_loop_hz - elapsed_us) / 1000);
        }
    }
    return 0;
}
