/* Majority rule with five opinions; the opinions heard are sorted by a recursive quicksort
 * in a global array; waits in a recursive function. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <stdbool.h>

#define NB_OPINIONS 5
#define BOX 32
#define DEPTH 6

uint8_t opinion;
static uint8_t box[BOX];
static int box_n = 0;
static uint32_t counts[NB_OPINIONS];
static uint32_t total = 0, decisions = 0, rests = 0, changes = 0;
static int depth_now = 0, depth_errors = 0;
static uint16_t ident;

static void quick(uint8_t *a, int lo, int hi) {
    if (lo >= hi) return;
    uint8_t p = a[(lo + hi) / 2];
    int i = lo, j = hi;
    while (i <= j) {
        while (a[i] < p) i++;
        while (a[j] > p) j--;
        if (i <= j) { uint8_t t = a[i]; a[i] = a[j]; a[j] = t; i++; j--; }
    }
    quick(a, lo, j);
    quick(a, i, hi);
}

static void listen(void) {
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t m;
        pogobot_infrared_recover_next_message(&m);
        if (m.header.payload_length != 3 || m.payload[0] != 'O' || m.payload[1] >= NB_OPINIONS) continue;
        counts[m.payload[1]]++;
        total++;
        if (box_n < BOX) box[box_n++] = m.payload[1];
    }
}

/* sleeps on the way down and listens on the way up */
static uint32_t rest(int depth) {
    uint32_t mark[4];
    for (int i = 0; i < 4; i++) mark[i] = ident * 1000u + depth * 10u + i;
    depth_now++;
    int mine = depth_now;
    msleep(10);
    uint32_t r = depth > 1 ? rest(depth - 1) : 0;
    listen();
    if (mine != depth_now) depth_errors++;
    for (int i = 0; i < 4; i++) if (mark[i] != ident * 1000u + depth * 10u + i) depth_errors++;
    depth_now--;
    rests++;
    return r + 1;
}

static bool decide(void) {
    quick(box, 0, box_n - 1);
    int best = -1, best_n = 0, run = 0;
    for (int i = 0; i < box_n; i++) {
        run = (i > 0 && box[i] == box[i - 1]) ? run + 1 : 1;
        if (run > best_n) { best_n = run; best = box[i]; }
        if (i > 0 && box[i] < box[i - 1]) return false;
    }
    if (best >= 0 && best != opinion && (best_n * 2 > box_n || rand() % 8 == 0)) {
        opinion = (uint8_t)best;
        changes++;
    }
    box_n = 0;
    decisions++;
    return true;
}

int main(void) {
    static const uint8_t rgb[NB_OPINIONS][3] = { {25,0,0}, {0,25,0}, {0,0,25}, {25,25,0}, {0,25,25} };
    uint32_t main_decisions = 0, main_rests = 0;
    bool sorted = true;
    time_reference_t since;

    pogobot_init();
    ident = pogobot_helper_getid();
    srand(pogobot_helper_getRandSeed());
    opinion = rand() % NB_OPINIONS;
    uint8_t last = opinion;
    pogobot_stopwatch_reset(&since);

    for (;;) {
        if (last != opinion) printf("SELF BAD id=%u opinion changed in my absence\n", ident);
        uint8_t m[3] = { 'O', opinion, (uint8_t)ident };
        pogobot_infrared_sendShortMessage_omni(m, 3);
        pogobot_led_setColor(rgb[opinion][0], rgb[opinion][1], rgb[opinion][2]);
        main_rests += rest(DEPTH + (int)(main_decisions % 3));
        if (last != opinion) sorted = false;               /* only decide() may change it */
        sorted = decide() && sorted;
        main_decisions++;
        last = opinion;

        if (pogobot_stopwatch_get_elapsed_microseconds(&since) >= 1000000) {
            pogobot_stopwatch_offset_origin_microseconds(&since, 1000000);
            uint32_t s = 0;
            for (int i = 0; i < NB_OPINIONS; i++) s += counts[i];
            if (ident != pogobot_helper_getid()) printf("SELF BAD id=%u ident\n", pogobot_helper_getid());
            else if (depth_errors || depth_now != 0) printf("SELF BAD id=%u recursion %d %d\n", ident, depth_errors, depth_now);
            else if (decisions != main_decisions || rests != main_rests) printf("SELF BAD id=%u decisions\n", ident);
            else if (s != total || !sorted) printf("SELF BAD id=%u sums\n", ident);
            else printf("SELF ok id=%u opinion=%u changes=%lu heard=%lu\n", ident, opinion, (unsigned long)changes, (unsigned long)total);
        }
    }
}
