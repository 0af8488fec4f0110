/* Who is there? Robots gossip the ids they know of; the sorted set of ids is in memory from
 * malloc/realloc kept through a global, with canaries. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stddef.h>
#include <stdbool.h>
#include "pogobot.h"

#define CANARY 0xC0FFEE11u
#define PER_MSG 8

typedef struct {
    uint32_t canary_a;
    uint16_t count, capacity;
    uint16_t owner;
    uint16_t ids[];
} set_t;

typedef struct { uint8_t kind, n; uint16_t ids[PER_MSG]; } gossip_t;

static set_t *known = NULL;
static char *name = NULL;                     /* "robot-<id>" */
static uint32_t inserts = 0, grows = 0;

static int cmp_u16(const void *a, const void *b) {
    uint16_t x = *(uint16_t const *)a, y = *(uint16_t const *)b;
    return (x > y) - (x < y);
}

static uint32_t *tail(set_t *s) { return (uint32_t *)(void *)(s->ids + s->capacity); }

static set_t *grow(set_t *s, uint16_t capacity) {
    uint16_t c = (capacity + 4) & ~1;
    if ((offsetof(set_t, ids) + c * 2) % 4) c++;
    set_t *n = realloc(s, sizeof(set_t) + c * sizeof(uint16_t) + 8);
    if (n == NULL) { printf("no memory\n"); return s; }
    if (s == NULL) { n->count = 0; n->canary_a = CANARY; n->owner = pogobot_helper_getid(); }
    n->capacity = c;
    memcpy(tail(n), &(uint32_t){ CANARY }, 4);
    grows++;
    return n;
}

static bool insert(uint16_t id) {
    if (known->count && bsearch(&id, known->ids, known->count, sizeof(uint16_t), cmp_u16)) return false;
    if (known->count == known->capacity) known = grow(known, known->capacity * 3 / 2);
    known->ids[known->count++] = id;
    qsort(known->ids, known->count, sizeof(uint16_t), cmp_u16);
    inserts++;
    return true;
}

static const char *verify(uint16_t id, uint32_t n_inserted, char const *local_name) {
    uint32_t c;
    char expect[24];
    if (known->canary_a != CANARY) return "front canary";
    memcpy(&c, tail(known), 4);
    if (c != CANARY) return "tail canary";
    if (known->owner != id || id != pogobot_helper_getid()) return "owner";
    if (known->count != inserts || inserts != n_inserted) return "count";
    for (int i = 1; i < known->count; i++) if (known->ids[i - 1] >= known->ids[i]) return "order";
    if (!bsearch(&id, known->ids, known->count, sizeof(uint16_t), cmp_u16)) return "myself missing";
    snprintf(expect, sizeof(expect), "robot-%u", id);
    if (name != local_name || strcmp(name, expect) != 0) return "name";
    return NULL;
}

int main(void) {
    pogobot_init();
    uint16_t id = pogobot_helper_getid();
    uint32_t inserted = 0;
    srand(pogobot_helper_getRandSeed());
    name = malloc(24);
    char *const local_name = name;
    sprintf(name, "robot-%u", id);
    known = grow(NULL, 2);
    inserted += insert(id);

    for (uint32_t loop = 1; ; loop++) {
        pogobot_infrared_update();
        while (pogobot_infrared_message_available()) {
            message_t m;
            gossip_t g;
            pogobot_infrared_recover_next_message(&m);
            if (m.header.payload_length != sizeof(g)) continue;
            memcpy(&g, m.payload, sizeof(g));
            if (g.kind != 0x4E || g.n > PER_MSG) continue;
            for (int i = 0; i < g.n; i++) inserted += insert(g.ids[i]);
        }
        if (rand() % 10 < 3) {
            gossip_t g = { .kind = 0x4E, .n = 1 };
            g.ids[0] = id;
            while (g.n < PER_MSG && g.n <= known->count) g.ids[g.n++] = known->ids[rand() % known->count];
            pogobot_infrared_sendLongMessage_omniGen((uint8_t *)&g, sizeof(g));
        }
        pogobot_led_setColor(0, known->count / 2 > 25 ? 25 : known->count / 2, known->count < 5 ? 20 : 0);
        if (loop % 40 == 0) {
            const char *why = verify(id, inserted, local_name);
            if (why) printf("SELF BAD id=%u %s\n", id, why);
            else printf("SELF ok id=%u name=%s known=%u min=%u max=%u grows=%lu\n", id, name, known->count,
                        known->ids[0], known->ids[known->count - 1], (unsigned long)grows);
        }
        msleep(25);
    }
}
