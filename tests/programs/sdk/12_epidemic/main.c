/* Epidemic: a robot waits (only for messages, nothing else) for the infection, then spreads it.
 * Robot 0 is the index case. No clock is read until the infection. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct { char word[6]; uint16_t from; uint16_t generation; uint32_t strain; } germ_t;

static germ_t germ;
static uint32_t wakeups;
static uint8_t contacts[128];
static int nb_contacts = 0;
static uint16_t my;

/* waits for a germ; nested one level below main */
static void wait_for_infection(void) {
    message_t m;
    for (;;) {
        while (!pogobot_infrared_message_available()) {
            pogobot_infrared_update();
        }
        pogobot_infrared_recover_next_message(&m);
        wakeups++;
        if (m.header.payload_length == sizeof(germ_t) && memcmp(m.payload, "GERM!", 6) == 0) {
            memcpy(&germ, m.payload, sizeof(germ));
            germ.generation++;
            return;
        }
    }
}

static void meet(uint16_t id) {
    if (id < 128 && !contacts[id]) { contacts[id] = 1; nb_contacts++; }
}

int main(void) {
    germ_t copy;
    int rounds = 0, max_ms = 0;
    time_reference_t since;

    pogobot_init();
    my = pogobot_helper_getid();
    pogobot_led_setColor(0, 10, 0);

    if (my == 0) {
        memcpy(germ.word, "GERM!", 6);
        germ.strain = 0xABCD0000u | (uint16_t)pogobot_helper_getRandSeed();
        msleep(500);
    } else {
        wait_for_infection();
        meet(germ.from);
    }
    uint16_t const source = germ.from;
    germ.from = my;
    memcpy(&copy, &germ, sizeof(copy));
    pogobot_led_setColor(25, 0, 0);
    printf("infected: id=%u generation=%u by %u\n", my, germ.generation, source);
    srand(pogobot_helper_getRandSeed());
    pogobot_stopwatch_reset(&since);

    while (1) {
        pogobot_infrared_sendLongMessage_omniSpe((uint8_t *)&germ, sizeof(germ));
        int ms = 80 + rand() % 40;
        if (ms > max_ms) max_ms = ms;
        msleep(ms);
        pogobot_infrared_update();
        while (pogobot_infrared_message_available()) {
            message_t m;
            pogobot_infrared_recover_next_message(&m);
            germ_t *o = (germ_t *)m.payload;
            if (m.header.payload_length == sizeof(germ_t)) meet(o->from);
        }
        rounds++;
        if (pogobot_stopwatch_get_elapsed_microseconds(&since) >= 1000000) {
            pogobot_stopwatch_offset_origin_microseconds(&since, 1000000);
            int n = 0;
            for (int i = 0; i < 128; i++) n += contacts[i];
            if (my != pogobot_helper_getid() || germ.from != my) printf("SELF BAD id=%u id\n", pogobot_helper_getid());
            else if (memcmp(&copy, &germ, sizeof(germ)) != 0) printf("SELF BAD id=%u germ changed\n", my);
            else if (n != nb_contacts || contacts[my & 127]) printf("SELF BAD id=%u contacts\n", my);
            else if ((my == 0) != (germ.generation == 0)) printf("SELF BAD id=%u generation\n", my);
            else if ((my == 0) != (wakeups == 0)) printf("SELF BAD id=%u wakeups\n", my);
            else printf("SELF ok id=%u generation=%u strain=%08lx contacts=%d rounds=%d\n", my, germ.generation,
                        (unsigned long)germ.strain, nb_contacts, rounds);
        }
    }
    return 0;
}
