/* Hop-count gradient from robot 0, with waves numbered by the root. 60 Hz. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <stdbool.h>

#define FQCY 60
#define HOP_NONE 255
#define P_SEND 20

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    uint16_t wave;
    uint8_t hops;
} hop_msg_t;
#define MSG_SIZE ((uint16_t)sizeof(hop_msg_t))

/* global state of the robot */
uint16_t robot_id;
uint8_t hops = HOP_NONE;
uint16_t wave = 0;
uint16_t parent = 0xFFFF;
uint32_t nb_rx = 0, nb_tx = 0, nb_updates = 0;
bool is_root = false;
static const uint8_t colours[6][3] = { {25,0,0}, {25,12,0}, {20,20,0}, {0,25,0}, {0,15,15}, {0,0,25} };

static bool consider(hop_msg_t const *m) {
    bool newer = (int16_t)(m->wave - wave) > 0;
    if (is_root || m->hops == HOP_NONE) return false;
    if (newer || (m->wave == wave && m->hops + 1 < hops)) {
        wave = m->wave;
        hops = m->hops + 1;
        parent = m->sender_id;
        nb_updates++;
        return true;
    }
    return false;
}

static void receive(uint32_t *rx_count) {
    pogobot_infrared_update();
    for (int n = 0; n < 5 && pogobot_infrared_message_available(); n++) {
        message_t mr;
        pogobot_infrared_recover_next_message(&mr);
        if (mr.header.payload_length != MSG_SIZE) continue;
        consider((hop_msg_t const *)mr.payload);
        nb_rx++;
        (*rx_count)++;
    }
    pogobot_infrared_clear_message_queue();
}

static void emit(uint32_t *tx_count) {
    if (rand() % 100 >= P_SEND) return;
    hop_msg_t m = { .sender_id = robot_id, .wave = wave, .hops = hops };
    if (pogobot_infrared_sendLongMessage_omniGen((uint8_t *)&m, MSG_SIZE) == 0) {
        nb_tx++;
        (*tx_count)++;
    }
}

int main(void) {
    time_reference_t w, second;
    uint32_t ticks = 0, rx = 0, tx = 0;

    pogobot_init();
    robot_id = pogobot_helper_getid();
    srand(pogobot_helper_getRandSeed());
    is_root = robot_id == 0;
    if (is_root) { hops = 0; wave = 1; parent = 0; }
    pogobot_stopwatch_reset(&second);

    while (1) {
        pogobot_stopwatch_reset(&w);
        receive(&rx);
        emit(&tx);
        if (is_root && ticks % 300 == 299) wave++;         /* about every five seconds */
        if (hops == HOP_NONE) pogobot_led_setColor(3, 3, 3);
        else pogobot_led_setColor(colours[hops % 6][0], colours[hops % 6][1], colours[hops % 6][2]);

        if (pogobot_stopwatch_get_elapsed_microseconds(&second) > 1000000) {
            pogobot_stopwatch_offset_origin_microseconds(&second, 1000000);
            if (robot_id != pogobot_helper_getid()) printf("SELF BAD id=%d robot_id=%d\n", pogobot_helper_getid(), robot_id);
            else if (is_root != (robot_id == 0)) printf("SELF BAD id=%d root\n", robot_id);
            else if (rx != nb_rx || tx != nb_tx) printf("SELF BAD id=%d counters\n", robot_id);
            else if (is_root ? hops != 0 : hops == 0) printf("SELF BAD id=%d hops=%d\n", robot_id, hops);
            else if (!is_root && parent == robot_id) printf("SELF BAD id=%d own parent\n", robot_id);
            else printf("SELF ok id=%d hops=%d parent=%d wave=%d rx=%lu tx=%lu\n", robot_id, hops, parent, wave,
                        (unsigned long)nb_rx, (unsigned long)nb_tx);
        }

        int32_t us = pogobot_stopwatch_get_elapsed_microseconds(&w);
        if (us < 1000000 / FQCY) msleep((1000000 / FQCY - us) / 1000);
        ticks++;
    }
    return 0;
}
