/* Vicsek-like alignment. Nobody has a compass: every robot integrates its gyro from an
 * arbitrary start and shares its turning angle; stopwatch_lap for dt. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>

#ifndef M_PI
#define M_PI 3.14159265358979323846
#endif
#define N_MAX 16

typedef struct __attribute__((packed)) { uint8_t magic; uint16_t id; int16_t angle; } heading_t;
typedef struct { uint16_t id; float angle; uint32_t tick; } neighbour_t;

struct robot_state {
    uint16_t id;
    float heading, target;
    uint32_t ticks;
    double sum_dt;
    neighbour_t nb[N_MAX];
    int n;
    uint16_t cmd_l, cmd_r;
} st;
static struct robot_state *const me = &st;
static float trig[64];                                 /* sine table */

static float wrap(float a) {
    while (a > (float)M_PI) a -= 2.0f * (float)M_PI;
    while (a <= -(float)M_PI) a += 2.0f * (float)M_PI;
    return a;
}

static float table_sin(float a) {
    int i = (int)lrintf(a / (2.0f * (float)M_PI) * 64.0f);
    return trig[((i % 64) + 64) % 64];
}

static void hear(void) {
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t m;
        heading_t h;
        pogobot_infrared_recover_next_message(&m);
        if (m.header.payload_length != sizeof h) continue;
        memcpy(&h, m.payload, sizeof h);
        if (h.magic != 'V') continue;
        int k;
        for (k = 0; k < me->n && me->nb[k].id != h.id; k++) ;
        if (k == N_MAX) continue;
        if (k == me->n) me->n++;
        me->nb[k] = (neighbour_t){ h.id, h.angle / 10000.0f, me->ticks };
    }
    for (int k = 0; k < me->n; )
        if (me->ticks - me->nb[k].tick > 60) me->nb[k] = me->nb[--me->n];
        else k++;
}

static void steer(void) {
    float sx = table_sin(me->heading + (float)M_PI / 2), sy = table_sin(me->heading);
    for (int k = 0; k < me->n; k++) {
        sx += table_sin(me->nb[k].angle + (float)M_PI / 2);
        sy += table_sin(me->nb[k].angle);
    }
    me->target = atan2f(sy, sx);
    float e = wrap(me->target - me->heading);
    me->cmd_l = e > 0.3f ? motorStop : motorHalf;       /* counter-clockwise: right motor alone */
    me->cmd_r = e < -0.3f ? motorStop : motorHalf;
    pogobot_motor_set(motorL, me->cmd_l);
    pogobot_motor_set(motorR, me->cmd_r);
}

int main(void) {
    time_reference_t lap, begin, pace;
    uint32_t ticks = 0;
    double shadow_dt = 0.0;
    float shadow_heading;

    pogobot_init();
    srand(pogobot_helper_getRandSeed());
    me->id = pogobot_helper_getid();
    for (int i = 0; i < 64; i++) trig[i] = sinf(2.0f * (float)M_PI * i / 64.0f);
    shadow_heading = me->heading = wrap((float)(rand() % 6283) / 1000.0f);
    pogobot_stopwatch_reset(&lap);
    pogobot_stopwatch_reset(&begin);

    for (;;) {
        pogobot_stopwatch_reset(&pace);
        float acc[3], gyro[3];
        pogobot_imu_read(acc, gyro);
        double dt = pogobot_stopwatch_lap(&lap) / 1e6;
        me->sum_dt += dt;
        shadow_dt += dt;
        me->heading = wrap(me->heading + gyro[2] * (float)dt);
        shadow_heading = wrap(shadow_heading + gyro[2] * (float)dt);
        hear();
        steer();
        if (rand() % 4 == 0) {
            heading_t h = { 'V', me->id, (int16_t)lrintf(me->heading * 10000.0f) };
            pogobot_infrared_sendShortMessage_omni((uint8_t *)&h, sizeof h);
        }
        ticks++;
        me->ticks++;
        if (ticks % 50 == 0) {
            double elapsed = pogobot_stopwatch_get_elapsed_microseconds(&begin) / 1e6;
            float tsum = 0;
            for (int i = 0; i < 64; i++) tsum += trig[i] * trig[i];
            const char *bad = NULL;
            if (me->id != pogobot_helper_getid()) bad = "id";
            else if (me->ticks != ticks) bad = "ticks";
            else if (me->heading != shadow_heading) bad = "heading";
            else if (me->sum_dt != shadow_dt) bad = "sum of dt";
            else if (fabs(elapsed - shadow_dt) > 0.2) bad = "laps do not add up to the elapsed time";
            else if (fabsf(tsum - 32.0f) > 0.01f) bad = "sine table";
            if (bad) printf("SELF BAD id=%u %s\n", pogobot_helper_getid(), bad);
            else printf("SELF ok id=%u heading=%.2f target=%.2f nb=%d t=%.2f\n", me->id, me->heading, me->target, me->n, elapsed);
        }
        while (pogobot_stopwatch_get_elapsed_microseconds(&pace) < 20000) ;      /* 50 Hz */
    }
}
