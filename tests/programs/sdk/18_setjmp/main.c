/* A mission of several stages; a fault deep inside of a stage jumps back to the supervisor
 * in main() with longjmp, which counts it and starts the stage again. */
#include <pogobot.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <stdint.h>

enum fault { NO_FAULT = 0, FAULT_LIGHT, FAULT_RADIO, FAULT_TIMEOUT, NB_FAULTS };
static const char *const fault_name[NB_FAULTS] = { "none", "light", "radio", "timeout" };

static jmp_buf supervisor;
static uint32_t faults[NB_FAULTS];
static uint32_t stage_done[3], stage_begun[3];
static volatile int stage = 0;
static uint32_t lcg;
static int last_fault = NO_FAULT;
static uint16_t whoami;

static uint32_t next(void) { lcg = lcg * 1664525u + 1013904223u; return lcg >> 16; }

static void fail(enum fault f) {
    faults[f]++;
    longjmp(supervisor, f);
}

static int32_t measure(int deep) {
    char frame[16];
    for (int i = 0; i < 16; i++) frame[i] = (char)(deep + i);
    if (deep > 0) return measure(deep - 1) + frame[0] - deep;
    msleep(5);
    if (next() % 10 == 0) fail(FAULT_LIGHT);
    return pogobot_photosensors_read(0);
}

static void stage_measure(void) {
    int32_t sum = 0;
    for (int i = 0; i < 8; i++) sum += measure(i % 4);
    pogobot_led_setColor(sum > 8000 ? 25 : 5, 5, 0);
}

static void stage_talk(void) {
    uint8_t m[2] = { 'J', (uint8_t)whoami };
    time_reference_t limit;
    pogobot_infrared_clear_message_queue();
    pogobot_infrared_sendShortMessage_omni(m, 2);
    pogobot_timer_init(&limit, 60000);
    while (!pogobot_infrared_message_available()) {
        pogobot_infrared_update();
        if (pogobot_timer_has_expired(&limit)) fail(FAULT_TIMEOUT);
    }
    message_t r;
    pogobot_infrared_recover_next_message(&r);
    if (r.header.payload_length != 2 || r.payload[0] != 'J' || next() % 16 == 0) fail(FAULT_RADIO);
}

static void stage_pause(void) {
    time_reference_t t;
    pogobot_timer_init(&t, 20000 + (int32_t)(next() % 20) * 1000);
    pogobot_timer_wait_for_expiry(&t);
}

static void (*const stages[3])(void) = { stage_measure, stage_talk, stage_pause };

int main(void) {
    static time_reference_t sec;
    volatile uint32_t caught = 0, completed = 0, started = 0;

    pogobot_init();
    whoami = pogobot_helper_getid();
    lcg = 12345u + whoami * 777u;
    pogobot_stopwatch_reset(&sec);

    int f = setjmp(supervisor);
    if (f != 0) {
        caught++;
        last_fault = f;
        msleep(4);
    }

    for (;;) {
        if (pogobot_stopwatch_get_elapsed_microseconds(&sec) >= 1000000) {
            pogobot_stopwatch_offset_origin_microseconds(&sec, 1000000);
            uint32_t fs = 0, ds = 0, bs = 0;
            for (int i = 0; i < NB_FAULTS; i++) fs += faults[i];
            for (int i = 0; i < 3; i++) { ds += stage_done[i]; bs += stage_begun[i]; }
            if (whoami != pogobot_helper_getid()) printf("SELF BAD id=%u whoami=%u\n", pogobot_helper_getid(), whoami);
            else if (fs != caught) printf("SELF BAD id=%u faults %lu caught %lu\n", whoami, (unsigned long)fs, (unsigned long)caught);
            else if (ds != completed || bs != started || bs != ds + fs) printf("SELF BAD id=%u stages\n", whoami);
            else if (stage != (int)(completed % 3)) printf("SELF BAD id=%u stage=%d\n", whoami, stage);
            else printf("SELF ok id=%u completed=%lu faults=%lu/%lu/%lu last=%s\n", whoami, (unsigned long)completed,
                        (unsigned long)faults[1], (unsigned long)faults[2], (unsigned long)faults[3], fault_name[last_fault]);
        }
        stage_begun[stage]++;
        started++;
        stages[stage]();
        stage_done[stage]++;
        completed++;
        stage = (stage + 1) % 3;
    }
}
