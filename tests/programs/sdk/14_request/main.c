/* Requests and answers with timeouts and retries. While waiting for an answer a robot
 * serves the requests of others, in nested functions. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stdbool.h>

#define TIMEOUT_US 150000
#define RETRIES 3
#define NB_KNOWN 16

typedef enum { MSG_HI = 'h', MSG_ASK = 'a', MSG_ANSWER = 'r' } kind_t;
typedef struct __attribute__((packed)) { uint8_t kind; uint16_t from, to; uint16_t nonce; uint32_t value; } packet_t;

static struct { uint16_t id; uint32_t secret; } me;
static struct { bool waiting, done; uint16_t to, nonce; uint32_t value; } pending;
static struct { uint32_t asked, answered, failed, retries, served, wrong; } stat;
static uint16_t known[NB_KNOWN];
static int nb_known;
static int32_t worst_us = 0;

static uint32_t secret_of(uint16_t id) { return 2654435761u * (id + 1u); }

static void transmit(kind_t k, uint16_t to, uint16_t nonce, uint32_t value) {
    packet_t p = { .kind = k, .from = me.id, .to = to, .nonce = nonce, .value = value };
    pogobot_infrared_sendShortMessage_omni((uint8_t *)&p, sizeof(p));
}

static void serve(void) {
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t mr;
        packet_t p;
        pogobot_infrared_recover_next_message(&mr);
        if (mr.header.payload_length < sizeof(p)) continue;
        memcpy(&p, mr.payload, sizeof(p));
        bool have = false;
        for (int i = 0; i < nb_known; i++) have = have || known[i] == p.from;
        if (!have) known[nb_known < NB_KNOWN ? nb_known++ : rand() % NB_KNOWN] = p.from;
        if (p.kind == MSG_ASK && p.to == me.id) {
            stat.served++;
            transmit(MSG_ANSWER, p.from, p.nonce, me.secret ^ p.nonce);
        } else if (p.kind == MSG_ANSWER && p.to == me.id && pending.waiting
                   && p.nonce == pending.nonce && p.from == pending.to) {
            pending.value = p.value;
            pending.done = true;
            pending.waiting = false;
        }
    }
}

static bool wait_answer(int32_t timeout) {
    time_reference_t t;
    pogobot_timer_init(&t, timeout);
    while (pogobot_timer_get_remaining_microseconds(&t) > 0) {
        serve();
        if (pending.done) return true;
        msleep(2);
    }
    return false;
}

static bool ask(uint16_t to, uint32_t *value) {
    time_reference_t sw;
    pogobot_stopwatch_reset(&sw);
    pending.to = to;
    pending.nonce = (uint16_t)(stat.asked * 50 + me.id);
    pending.waiting = true;
    pending.done = false;
    stat.asked++;
    for (int k = 0; k < RETRIES; k++) {
        if (k) stat.retries++;
        transmit(MSG_ASK, to, pending.nonce, 0);
        if (wait_answer(TIMEOUT_US)) {
            int32_t us = pogobot_stopwatch_get_elapsed_microseconds(&sw);
            if (us > worst_us) worst_us = us;
            *value = pending.value;
            stat.answered++;
            return true;
        }
    }
    pending.waiting = false;
    stat.failed++;
    return false;
}

int main(void) {
    uint32_t calls = 0, yes = 0;
    time_reference_t sec;
    pogobot_init();
    me.id = pogobot_helper_getid();
    me.secret = secret_of(me.id);
    srand(pogobot_helper_getRandSeed());
    pogobot_stopwatch_reset(&sec);

    while (1) {
        transmit(MSG_HI, 0xFFFF, 0, 0);
        wait_answer(100000 + 1000 * (rand() % 50));          /* pending.done is stale or false here */
        pending.done = false;
        if (nb_known > 0) {
            uint16_t to = known[rand() % nb_known];
            uint32_t v = 0;
            calls++;
            bool ok = ask(to, &v);
            uint16_t nonce = (uint16_t)((calls - 1) * 50 + me.id);
            if (ok) { yes++; if ((v ^ nonce) != secret_of(to)) stat.wrong++; }
            pending.done = false;
            pogobot_led_setColor(ok ? 0 : 25, ok ? 25 : 0, 0);
        }
        if (pogobot_stopwatch_get_elapsed_microseconds(&sec) >= 1000000) {
            pogobot_stopwatch_offset_origin_microseconds(&sec, 1000000);
            if (me.id != pogobot_helper_getid() || me.secret != secret_of(me.id)) printf("SELF BAD id=%u identity\n", pogobot_helper_getid());
            else if (stat.asked != calls || stat.answered != yes) printf("SELF BAD id=%u calls\n", me.id);
            else if (stat.answered + stat.failed != stat.asked) printf("SELF BAD id=%u sums\n", me.id);
            else if (stat.wrong) printf("SELF BAD id=%u wrong answers %lu\n", me.id, (unsigned long)stat.wrong);
            else printf("SELF ok id=%u asked=%lu answered=%lu failed=%lu retries=%lu served=%lu worst=%ldus\n", me.id,
                        (unsigned long)stat.asked, (unsigned long)stat.answered, (unsigned long)stat.failed,
                        (unsigned long)stat.retries, (unsigned long)stat.served, (long)worst_us);
        }
    }
}
