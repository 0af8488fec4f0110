/* Leader election: the smallest id wins. No pacing: the program waits for messages only,
 * with sending and reporting inside of the waiting loop. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>

typedef struct { uint16_t from, leader; uint32_t round; } vote_t;

static struct {
    uint16_t id, leader;
    uint32_t sent, received, changes, reports;
    time_reference_t since_send, since_report;
    int32_t send_period;
} g;

static uint16_t history[16];           /* the leaders followed so far: strictly falling */

static void follow(uint16_t who) {
    g.leader = who;
    if (g.changes < 16) history[g.changes] = who;
    g.changes++;
}

static void send_vote(void) {
    vote_t v = { g.id, g.leader, g.sent };
    pogobot_infrared_sendShortMessage_omni((uint8_t *)&v, sizeof v);
    g.sent++;
    g.send_period = 80000 + rand() % 40000;
    pogobot_stopwatch_reset(&g.since_send);
}

static void report(uint32_t const *received_local, uint16_t const *id_local) {
    const char *why = "";
    if (g.id != *id_local || g.id != pogobot_helper_getid()) why = "id";
    else if (g.received != *received_local) why = "received";
    else if (g.leader > g.id) why = "leader greater than id";
    else if (history[0] != g.id) why = "history start";
    else for (uint32_t i = 1; i < g.changes && i < 16; i++)
        if (history[i] >= history[i - 1]) why = "history order";
    g.reports++;
    if (*why) printf("SELF BAD id=%u %s\n", pogobot_helper_getid(), why);
    else printf("SELF ok id=%u leader=%u changes=%lu received=%lu\n", g.id, g.leader,
                (unsigned long)g.changes, (unsigned long)g.received);
}

int main(void) {
    uint32_t received = 0;
    uint16_t id;
    message_t m;

    pogobot_init();
    pogobot_infrared_set_power(pogobot_infrared_emitter_power_max);
    srand(pogobot_helper_getRandSeed());
    g.id = id = pogobot_helper_getid();
    follow(id);
    pogobot_stopwatch_reset(&g.since_report);
    send_vote();

    while (1) {
        while (!pogobot_infrared_message_available()) {
            pogobot_infrared_update();
            if (pogobot_stopwatch_get_elapsed_microseconds(&g.since_send) > g.send_period) send_vote();
            if (pogobot_stopwatch_get_elapsed_microseconds(&g.since_report) >= 1000000) {
                pogobot_stopwatch_offset_origin_microseconds(&g.since_report, 1000000);
                report(&received, &id);
            }
        }
        pogobot_infrared_recover_next_message(&m);
        if (m.header.payload_length != sizeof(vote_t)) continue;
        vote_t *v = (vote_t *)m.payload;
        g.received++;
        received++;
        if (v->leader < g.leader) follow(v->leader);
        if (g.leader == g.id) pogobot_led_setColor(0, 25, 0);
        else pogobot_led_setColor(g.leader % 5 * 5, 0, 10);
    }
}
