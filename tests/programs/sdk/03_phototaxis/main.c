/* Phototaxis: move while it gets lighter, tumble when it gets darker, stop above a
 * threshold. Light samples in a ring buffer with a running sum. msleep(10). */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIN 32
#define GOAL_LEVEL 12000

typedef enum { FORWARD, TURN_LEFT, TURN_RIGHT, GOAL } mode_e;
static const char *mode_name[] = { "forward", "left", "right", "goal" };

struct light_filter {
    int32_t samples[WIN];
    int32_t sum;
    uint16_t head;
    uint16_t count;
} filter;

static mode_e mode = FORWARD;
static int mode_left = 0;             /* loops still to go in this mode */
static int32_t best = 0;
static uint32_t loops = 0;
static uint16_t stored_id = 0xFFFF;
uint32_t mode_hist[4];

static int32_t push(struct light_filter *f, int32_t v) {
    if (f->count == WIN) f->sum -= f->samples[f->head];
    else f->count++;
    f->samples[f->head] = v;
    f->sum += v;
    f->head = (f->head + 1) % WIN;
    return f->sum / f->count;
}

static void drive(uint16_t l, uint16_t r) {
    static uint16_t last_l = 0xFFFF, last_r = 0xFFFF;
    if (l != last_l || r != last_r || mode == FORWARD) {
        pogobot_motor_power_set(motorL, l);
        pogobot_motor_power_set(motorR, r);
        last_l = l;
        last_r = r;
    }
}

static void choose(int32_t mean, int16_t fl, int16_t fr) {
    if (mean >= GOAL_LEVEL) { mode = GOAL; mode_left = 1; return; }
    if (mode_left > 0) { mode_left--; return; }
    if (mean + 20 < best) {
        mode = fl > fr ? TURN_LEFT : (fr > fl ? TURN_RIGHT : (rand() % 2 ? TURN_LEFT : TURN_RIGHT));
        mode_left = 10 + rand() % 50;
        best = mean;
    } else {
        mode = FORWARD;
        mode_left = 20;
        if (mean > best) best = mean;
    }
}

int main(void) {
    uint32_t my_loops = 0, my_hist[4] = { 0, 0, 0, 0 };
    pogobot_init();
    memset(&filter, 0, sizeof(filter));
    stored_id = pogobot_helper_getid();
    srand(pogobot_helper_getRandSeed());

    while (1) {
        int16_t b = pogobot_photosensors_read(0);
        int16_t fl = pogobot_photosensors_read(1);
        int16_t fr = pogobot_photosensors_read(2);
        int32_t mean = push(&filter, ((int32_t)b + fl + fr) / 3);
        choose(mean, fl, fr);
        switch (mode) {
            case FORWARD:    drive(motorFull, motorFull); pogobot_led_setColor(0, 20, 0); break;
            case TURN_LEFT:  drive(motorStop, motorHalf); pogobot_led_setColor(20, 0, 0); break;
            case TURN_RIGHT: drive(motorHalf, motorStop); pogobot_led_setColor(20, 10, 0); break;
            case GOAL:       drive(motorStop, motorStop); pogobot_led_setColor(0, 0, 25); break;
        }
        mode_hist[mode]++;
        my_hist[mode]++;
        loops++;
        my_loops++;

        if (my_loops % 100 == 0) {
            int32_t s = 0;
            for (int i = 0; i < filter.count; i++) s += filter.samples[i];
            if (stored_id != pogobot_helper_getid())
                printf("SELF BAD id=%u id was %u\n", pogobot_helper_getid(), stored_id);
            else if (loops != my_loops)
                printf("SELF BAD id=%u loops %lu not %lu\n", stored_id, (unsigned long)loops, (unsigned long)my_loops);
            else if (s != filter.sum || filter.head != my_loops % WIN)
                printf("SELF BAD id=%u filter sum\n", stored_id);
            else if (memcmp(my_hist, mode_hist, sizeof(my_hist)) != 0)
                printf("SELF BAD id=%u histogram\n", stored_id);
            else
                printf("SELF ok id=%u light=%ld mode=%s\n", stored_id, (long)mean, mode_name[mode]);
        }
        msleep(10);
    }
}
