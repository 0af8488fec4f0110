/* Run and tumble at 60 Hz, states as function pointers, own random generator. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <stdbool.h>

#define FQCY 60

typedef void (*state_fn)(void);
static void st_run(void);
static void st_tumble(void);

static state_fn current = st_tumble;
static state_fn const states[2] = { st_run, st_tumble };
static uint32_t nb_entered[2] = { 0, 0 };
static uint32_t transitions = 0;
static int32_t duration_us = 300000;
static time_reference_t phase_watch;
static uint8_t dir_mem[3];
static float gyro_sum = 0.0f, gyro_max = 0.0f;

uint32_t rng_state = 0;
uint32_t rng_calls = 0;

static uint32_t xorshift(uint32_t *s) {
    uint32_t x = *s;
    x ^= x << 13; x ^= x >> 17; x ^= x << 5;
    return *s = x;
}

static uint32_t rnd(uint32_t lo, uint32_t hi) {
    rng_calls++;
    return lo + xorshift(&rng_state) % (hi - lo);
}

static void enter(int s, int32_t d) {
    current = states[s];
    nb_entered[s]++;
    transitions++;
    duration_us = d;
    pogobot_stopwatch_reset(&phase_watch);
}

static void st_run(void) {
    if (pogobot_stopwatch_get_elapsed_microseconds(&phase_watch) < duration_us) return;
    bool left = rnd(0, 2) == 0;
    enter(1, (int32_t)rnd(100, 1100) * 1000);
    pogobot_led_setColor(25, 0, 0);
    pogobot_motor_set(motorL, left ? motorStop : motorFull);
    pogobot_motor_set(motorR, left ? motorFull : motorStop);
}

static void st_tumble(void) {
    float acc[3], gyro[3];
    pogobot_imu_read(acc, gyro);
    gyro_sum += gyro[2];
    float a = gyro[2] < 0 ? -gyro[2] : gyro[2];
    if (a > gyro_max) gyro_max = a;
    if (pogobot_stopwatch_get_elapsed_microseconds(&phase_watch) < duration_us) return;
    enter(0, (int32_t)rnd(200, 1200) * 1000);
    pogobot_led_setColor(0, 25, 0);
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
}

int main(void) {
    pogobot_init();
    uint16_t const id = pogobot_helper_getid();
    uint32_t pogobot_ticks = 0, shadow_calls = 0, shadow_rng;
    time_reference_t w, report;

    shadow_rng = rng_state = 2463534242u + 7919u * (uint32_t)id + (uint16_t)pogobot_helper_getRandSeed() * 65536u;
    if (rng_state == 0) shadow_rng = rng_state = 1;
    pogobot_motor_dir_mem_get(dir_mem);
    pogobot_motor_dir_set(motorR, dir_mem[0]);
    pogobot_motor_dir_set(motorL, dir_mem[1]);
    pogobot_stopwatch_reset(&phase_watch);
    pogobot_stopwatch_reset(&report);

    for (;;) {
        pogobot_stopwatch_reset(&w);
        current();

        if (pogobot_stopwatch_get_elapsed_microseconds(&report) >= 1000000) {
            pogobot_stopwatch_reset(&report);
            while (shadow_calls < rng_calls) { xorshift(&shadow_rng); shadow_calls++; }
            const char *bad = NULL;
            if (id != pogobot_helper_getid()) bad = "id";
            else if (shadow_rng != rng_state) bad = "rng";
            else if (nb_entered[0] + nb_entered[1] != transitions) bad = "transitions";
            else if (rng_calls != nb_entered[0] + 2 * nb_entered[1]) bad = "calls";
            else if (current != states[0] && current != states[1]) bad = "state";
            if (bad) printf("SELF BAD id=%u %s\n", id, bad);
            else printf("SELF ok id=%u runs=%lu tumbles=%lu ticks=%lu gyromax=%d mrad/s\n", id,
                        (unsigned long)nb_entered[0], (unsigned long)nb_entered[1],
                        (unsigned long)pogobot_ticks, (int)(gyro_max * 1000.0f));
        }

        int32_t us = pogobot_stopwatch_get_elapsed_microseconds(&w);
        if (us < 1000000 / FQCY)
            msleep((1000000 / FQCY - us) / 1000);
        pogobot_ticks++;
    }
    return 0;
}
