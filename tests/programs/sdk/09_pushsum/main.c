/* Push-sum average of the ids. A ledger on the stack of main() knows what came in and went out. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>

#define FQCY 30
#define MAX_N 40
#define TTL_US 1000000

typedef struct __attribute__((packed)) { uint8_t type; uint16_t id; uint32_t round; float s, w; } share_t;

typedef struct { uint16_t id; uint32_t last_round; time_reference_t heard; int alive; } peer_t;
typedef struct { double s_in, w_in, s_out, w_out; uint32_t n_in, n_out; } ledger_t;

double s, w = 1.0;
uint32_t round_no = 0;
static peer_t peers[MAX_N];
static int n_peers = 0;
static uint16_t self;
static uint32_t n_in = 0, n_out = 0;

static peer_t *get_peer(uint16_t id) {
    for (int i = 0; i < n_peers; i++) if (peers[i].id == id) return &peers[i];
    if (n_peers == MAX_N) return NULL;
    peer_t *p = &peers[n_peers++];
    memset(p, 0, sizeof *p);
    p->id = id;
    return p;
}

static int degree(void) {
    int d = 0;
    for (int i = 0; i < n_peers; i++) {
        peers[i].alive = pogobot_stopwatch_get_elapsed_microseconds(&peers[i].heard) < TTL_US;
        d += peers[i].alive;
    }
    return d;
}

static void receive(ledger_t *l) {
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t m;
        share_t sh;
        pogobot_infrared_recover_next_message(&m);
        if (m.header.payload_length != sizeof(sh)) continue;
        memcpy(&sh, m.payload, sizeof(sh));
        if (!isfinite(sh.s) || !isfinite(sh.w)) continue;
        peer_t *p = get_peer(sh.id);
        if (p == NULL) continue;
        pogobot_stopwatch_reset(&p->heard);
        if (sh.type != 2 || sh.round <= p->last_round) continue;     /* a copy from another face */
        p->last_round = sh.round;
        s += sh.s; w += sh.w; n_in++;
        l->s_in += sh.s; l->w_in += sh.w; l->n_in++;
    }
}

static void send(ledger_t *l, int d) {
    share_t sh = { .type = 1, .id = self, .round = round_no, .s = 0, .w = 0 };
    if (d > 0) {
        double ks = s / (d + 1), kw = w / (d + 1);
        sh.type = 2;
        sh.round = ++round_no;
        sh.s = (float)ks; sh.w = (float)kw;
        l->s_out += s - ks; l->w_out += w - kw; l->n_out++;
        s = ks; w = kw;
        n_out++;
    }
    pogobot_infrared_sendShortMessage_omni((uint8_t *)&sh, sizeof(sh));
}

int main(void) {
    ledger_t l = { 0 };
    time_reference_t t, sec;
    uint32_t i = 0;

    pogobot_init();
    self = pogobot_helper_getid();
    s = self;
    double const s0 = s;
    pogobot_stopwatch_reset(&sec);

    while (1) {
        pogobot_stopwatch_reset(&t);
        receive(&l);
        if (i % 6 == (uint32_t)self % 6) send(&l, degree());
        i++;
        if (pogobot_stopwatch_get_elapsed_microseconds(&sec) >= 1000000) {
            pogobot_stopwatch_offset_origin_microseconds(&sec, 1000000);
            double es = s0 + l.s_in - l.s_out, ew = 1.0 + l.w_in - l.w_out;
            int dup = 0;
            for (int a = 0; a < n_peers; a++) {
                if (peers[a].id == self) dup++;
                for (int b = a + 1; b < n_peers; b++) dup += peers[a].id == peers[b].id;
            }
            double est = w > 1e-12 ? s / w : 0.0;
            pogobot_led_setColor((uint8_t)(est < 25 ? est : 25), 5, 5);
            if (self != pogobot_helper_getid()) printf("SELF BAD id=%u self=%u\n", pogobot_helper_getid(), self);
            else if (fabs(es - s) > 1e-6 || fabs(ew - w) > 1e-6) printf("SELF BAD id=%u ledger %g %g\n", self, es - s, ew - w);
            else if (l.n_in != n_in || l.n_out != n_out || n_out != round_no) printf("SELF BAD id=%u numbers\n", self);
            else if (dup) printf("SELF BAD id=%u peers\n", self);
            else printf("SELF ok id=%u estimate=%.3f s=%.4f w=%.4f peers=%d round=%lu\n", self, est, s, w, n_peers, (unsigned long)round_no);
        }
        int32_t us = pogobot_stopwatch_get_elapsed_microseconds(&t);
        if (us < 1000000 / FQCY) msleep((1000000 / FQCY - us) / 1000);
    }
    return 0;
}
