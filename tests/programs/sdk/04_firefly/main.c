/* Firefly synchronisation (pulse coupled oscillators), 40 Hz, period of one second. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>

#define LOOP_MS 25
#define PERIOD 40            /* loops */
#define REFRACTORY 8

struct __attribute__((packed)) flash_msg { uint16_t id; uint8_t tag; };

int phase;
unsigned flashes = 0, heard = 0, jumps = 0;
static uint8_t led_on = 0;
static uint16_t me;
static unsigned heard_from[64];           /* by id modulo 64 */
static struct { uint32_t magic; uint16_t owner; uint32_t loops; } box = { 0xF1EEF1EEu, 0, 0 };

static void flash(void) {
    struct flash_msg m;
    m.id = me;
    m.tag = 'F';
    pogobot_infrared_sendShortMessage_omni((uint8_t *)&m, sizeof(m));
    pogobot_led_setColors(25, 25, 25, 0);
    led_on = 4;
    flashes++;
    phase = 0;
}

static void listen(void) {
    int coupled = 0;
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t mr;
        pogobot_infrared_recover_next_message(&mr);
        if (mr.header.payload_length < sizeof(struct flash_msg)) continue;
        struct flash_msg *f = (struct flash_msg *)mr.payload;
        if (f->tag != 'F') continue;
        heard++;
        heard_from[f->id % 64]++;
        if (phase > REFRACTORY && !coupled) {
            phase += 1 + phase / 8;
            jumps++;
            coupled = 1;
        }
    }
}

int main(void) {
    uint32_t loops = 0;
    unsigned f_local = 0;
    pogobot_init();
    me = pogobot_helper_getid();
    box.owner = me;
    srand(pogobot_helper_getRandSeed() + me);
    phase = rand() % PERIOD;

    for (;;) {
        listen();
        phase++;
        if (phase >= PERIOD) { flash(); f_local++; }
        if (led_on > 0 && --led_on == 0) pogobot_led_setColors(0, 0, 0, 0);

        loops++;
        box.loops++;
        if (loops % PERIOD == 0) {
            unsigned sum = 0;
            for (int i = 0; i < 64; i++) sum += heard_from[i];
            if (box.magic != 0xF1EEF1EEu || box.owner != pogobot_helper_getid() || me != box.owner)
                printf("SELF BAD id=%u owner %u\n", pogobot_helper_getid(), box.owner);
            else if (box.loops != loops)
                printf("SELF BAD id=%u loops\n", me);
            else if (f_local != flashes)
                printf("SELF BAD id=%u flashes %u %u\n", me, f_local, flashes);
            else if (sum != heard)
                printf("SELF BAD id=%u heard %u %u\n", me, sum, heard);
            else if (heard_from[me % 64] != 0)
                printf("SELF BAD id=%u heard myself\n", me);
            else
                printf("SELF ok id=%u phase=%d flashes=%u heard=%u jumps=%u\n", me, phase, flashes, heard, jumps);
        }
        msleep(LOOP_MS);
    }
    return 0;
}
