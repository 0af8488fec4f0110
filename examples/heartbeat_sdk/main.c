// Heartbeats, written for the robots alone: the same as the example heartbeat, with the SDK's own means.
//
// Shows: a program for the robots' SDK that runs in the simulator as it is: pogobot.h, an endless loop in main(),
// variables that are globals, messages that are taken out of the queue, a rate held with a stopwatch and msleep().
//
// Each robot sends its id in every second turn of its loop, and counts what it hears. What the simulator needs to
// record that is between #ifdef SIMULATOR and #endif; the program runs without it, too.
//
//     ./examples/heartbeat_sdk/heartbeat_sdk -c conf/heartbeat.yaml
#include "pogobot.h"

#ifdef SIMULATOR
#include "pogosim/simulation.h"
#endif

#define LOOP_HZ 60

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
} heartbeat_t;

// Variables of this robot.
static uint32_t turns;
static uint32_t sent;
static uint32_t heard;
static uint16_t last_sender;

static void receive(void) {
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t message;
        pogobot_infrared_recover_next_message(&message);
        if (message.header.payload_length == sizeof(heartbeat_t)) {
            heartbeat_t heartbeat;
            memcpy(&heartbeat, message.payload, sizeof(heartbeat));
            last_sender = heartbeat.sender_id;
            heard++;
        }
    }
}

static void send(void) {
    heartbeat_t heartbeat = {.sender_id = pogobot_helper_getid()};
    pogobot_infrared_sendShortMessage_omni((uint8_t*)&heartbeat, sizeof(heartbeat));
    sent++;
}

static void wait_for_next_turn(time_reference_t* turn) {
    int32_t const period_us = 1000000 / LOOP_HZ;
    int32_t const elapsed_us = pogobot_stopwatch_get_elapsed_microseconds(turn);
    if (elapsed_us < period_us) {
        msleep((period_us - elapsed_us) / 1000);
    }
}

#ifdef SIMULATOR
static void create_data_schema(void) {
    data_add_column_int32("sent");
    data_add_column_int32("heard");
}

static void export_data(void) {
    data_set_value_int32("sent", sent);
    data_set_value_int32("heard", heard);
}
#endif

int main(void) {
    pogobot_init();
    srand((unsigned)pogobot_helper_getRandSeed());
#ifdef SIMULATOR
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
#endif
    time_reference_t turn;
    for (;;) {
        pogobot_stopwatch_reset(&turn);
        if (turns % LOOP_HZ == 0 && pogobot_helper_getid() == 0) {
            printf("%lu sent, %lu heard, the last one from robot %u\n", (unsigned long)sent, (unsigned long)heard,
                   last_sender);
        }
        pogobot_led_setColor(heard % 26, 0, 0);
        if (rand() % 100 < 50) {
            send();
        }
        receive();
        turns++;
        wait_for_next_turn(&turn);
    }
}
