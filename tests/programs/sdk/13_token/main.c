/* Token passing: the token starts at robot 0; the holder keeps it for 200 ms and hands it over
 * to a neighbour heard before, repeating until acknowledged. Timers. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stdbool.h>

enum { HELLO = 1, PASS, ACK };
typedef struct { uint8_t type, pad; uint16_t from, to; uint16_t pad2; uint32_t serial; } tok_msg_t;

typedef enum { IDLE, HOLDING, HANDING, NB_STATES } state_t;
static state_t state = IDLE;
static uint32_t serial = 0;                 /* last serial number seen here */
static uint32_t got = 0, gave = 0, kept = 0, visits[NB_STATES];
static uint16_t me, target;
static int tries = 0;
static time_reference_t timer, hello;
static uint16_t friends[12];
static unsigned nfriends = 0, friend_head = 0;

static void go(state_t s, int32_t us) {
    state = s;
    visits[s]++;
    if (us > 0) pogobot_timer_init(&timer, us);
}

static void send(uint8_t type, uint16_t to, uint32_t sn) {
    tok_msg_t m = { .type = type, .from = me, .to = to, .serial = sn };
    pogobot_infrared_sendShortMessage_omni((uint8_t *)&m, sizeof(m));
}

static void befriend(uint16_t id) {
    for (unsigned i = 0; i < nfriends; i++) if (friends[i] == id) return;
    friends[friend_head] = id;
    friend_head = (friend_head + 1) % 12;
    if (nfriends < 12) nfriends++;
}

static void handle(tok_msg_t const *m) {
    befriend(m->from);
    if (m->to != me) return;
    if (m->type == PASS) {
        if (m->serial > serial && state == IDLE) {
            serial = m->serial;
            got++;
            go(HOLDING, 200000);
        }
        if (m->serial <= serial) send(ACK, m->from, m->serial);
    } else if (m->type == ACK && state == HANDING && m->from == target && m->serial == serial + 1) {
        serial++;
        gave++;
        go(IDLE, 0);
    }
}

static void act(void) {
    if (state == IDLE || !pogobot_timer_has_expired(&timer)) return;
    if (state == HOLDING) {
        if (nfriends == 0) { go(HOLDING, 200000); return; }
        target = friends[rand() % nfriends];
        tries = 0;
        go(HANDING, 0);
    }
    if (tries++ < 10) {
        send(PASS, target, serial + 1);
        pogobot_timer_init(&timer, 50000);
    } else {
        kept++;
        serial += 2;                        /* never the number of a lost acknowledgement again */
        go(HOLDING, 200000);
    }
}

int main(void) {
    uint32_t loops = 0;
    uint32_t tokens;                        /* what I must have: start + got - gave */
    time_reference_t rep;

    pogobot_init();
    me = pogobot_helper_getid();
    srand(pogobot_helper_getRandSeed());
    tokens = (me == 0);
    if (me == 0) { serial = 1; go(HOLDING, 1000000); }
    pogobot_timer_init(&hello, 1000 * (rand() % 200));
    pogobot_timer_init(&rep, 1000000);

    while (1) {
        uint32_t g0 = got, v0 = gave;
        pogobot_infrared_update();
        while (pogobot_infrared_message_available()) {
            message_t m;
            tok_msg_t t;
            pogobot_infrared_recover_next_message(&m);
            if (m.header.payload_length != sizeof(t)) continue;
            memcpy(&t, m.payload, sizeof(t));
            handle(&t);
        }
        act();
        tokens += (got - g0) - (gave - v0);
        if (pogobot_timer_has_expired(&hello)) {
            send(HELLO, 0xFFFF, 0);
            pogobot_timer_init(&hello, 150000 + 1000 * (rand() % 100));
        }
        pogobot_led_setColor(state == HOLDING ? 25 : 0, state == HANDING ? 25 : 0, state == IDLE ? 2 : 0);
        loops++;
        if (pogobot_timer_get_remaining_microseconds(&rep) <= 0) {
            pogobot_timer_offset_origin_microseconds(&rep, 1000000);
            if (me != pogobot_helper_getid()) printf("SELF BAD id=%u me=%u\n", pogobot_helper_getid(), me);
            else if (tokens != (uint32_t)(state != IDLE)) printf("SELF BAD id=%u tokens=%lu state=%d\n", me, (unsigned long)tokens, state);
            else if ((me == 0) + got - gave != tokens) printf("SELF BAD id=%u got-gave\n", me);
            else if (visits[IDLE] != gave || visits[HOLDING] < got) printf("SELF BAD id=%u visits\n", me);
            else printf("SELF ok id=%u holder=%d got=%lu gave=%lu kept=%lu serial=%lu\n", me, state != IDLE,
                        (unsigned long)got, (unsigned long)gave, (unsigned long)kept, (unsigned long)serial);
        }
        msleep(8);
    }
}
