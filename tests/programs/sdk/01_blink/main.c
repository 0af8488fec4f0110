/* Blink: four blinks per second, one half of each blink with a busy wait on a
 * stopwatch, the other half with msleep. */
#include <pogobot.h>
#include <stdio.h>

static uint16_t my_id;
static uint32_t blinks = 0;
static uint32_t *blinks_p = &blinks;          /* pointer to an own global */
static uint8_t palette[4][3] = { {25, 0, 0}, {0, 25, 0}, {0, 0, 25}, {25, 25, 0} };
int rotations = 0;

static void busy_wait_us(int32_t us) {
    time_reference_t t;
    pogobot_stopwatch_reset(&t);
    while (pogobot_stopwatch_get_elapsed_microseconds(&t) < us) {
        /* nothing */
    }
}

static uint32_t next_phase(void) {
    static uint32_t phase = 1000;
    phase++;
    return phase;
}

/* turn the palette by one: after 4k blinks it is as at the start */
static void rotate_palette(void) {
    uint8_t first[3];
    for (int c = 0; c < 3; c++) first[c] = palette[0][c];
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) palette[i][c] = palette[i + 1][c];
    for (int c = 0; c < 3; c++) palette[3][c] = first[c];
    rotations++;
}

static const char *check(uint32_t local_blinks, uint32_t phase) {
    if (my_id != pogobot_helper_getid()) return "id";
    if (blinks != local_blinks) return "blinks";
    if (blinks_p != &blinks || *blinks_p != local_blinks) return "pointer";
    if (phase != 1000 + local_blinks) return "phase";
    if (rotations != (int)local_blinks) return "rotations";
    if (palette[0][0] != 25 || palette[1][1] != 25 || palette[2][2] != 25 || palette[3][1] != 25) return "palette";
    return NULL;
}

int main(void) {
    uint32_t local_blinks = 0;
    pogobot_init();
    my_id = pogobot_helper_getid();
    printf("blink started on %u\n", my_id);

    while (1) {
        uint32_t phase = 0;
        for (int i = 0; i < 4; i++) {
            pogobot_led_setColor(palette[0][0], palette[0][1], palette[0][2]);
            busy_wait_us(125000);
            pogobot_led_setColor(0, 0, 0);
            msleep(125);
            rotate_palette();
            phase = next_phase();
            (*blinks_p)++;
            local_blinks++;
        }
        const char *why = check(local_blinks, phase);
        if (why == NULL)
            printf("SELF ok id=%u blinks=%lu\n", my_id, (unsigned long)blinks);
        else
            printf("SELF BAD id=%u %s\n", pogobot_helper_getid(), why);
    }
}
