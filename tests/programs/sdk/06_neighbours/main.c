/* Neighbour counting: linked list of entries from a static pool, with expiry.
 * 20 Hz by a timer. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stdbool.h>

#define POOL 24
#define MAX_AGE_US 1500000

typedef struct entry {
    struct entry *next;
    uint16_t id;
    uint16_t dirs;                 /* bit field of the receivers */
    time_reference_t seen;
} entry_t;

static entry_t pool[POOL];
static entry_t *free_list = NULL;
static entry_t *used_list = NULL;
static uint32_t added = 0, expired = 0, lost_full = 0;
static uint16_t my_id;
static uint8_t my_tag[4];

static void pool_init(void) {
    for (int i = 0; i < POOL; i++) {
        pool[i].next = free_list;
        free_list = &pool[i];
    }
}

static entry_t *find(uint16_t id) {
    for (entry_t *e = used_list; e != NULL; e = e->next)
        if (e->id == id) return e;
    return NULL;
}

static void note(uint16_t id, uint8_t receiver) {
    entry_t *e = find(id);
    if (e == NULL) {
        if (free_list == NULL) { lost_full++; return; }
        e = free_list;
        free_list = e->next;
        memset(e, 0, sizeof(*e));
        e->id = id;
        e->next = used_list;
        used_list = e;
        added++;
    }
    if (receiver < 4) e->dirs |= 1u << receiver;
    pogobot_stopwatch_reset(&e->seen);
}

static void expire(void) {
    entry_t **pp = &used_list;
    while (*pp != NULL) {
        entry_t *e = *pp;
        if (pogobot_stopwatch_get_elapsed_microseconds(&e->seen) > MAX_AGE_US) {
            *pp = e->next;
            e->next = free_list;
            free_list = e;
            expired++;
        } else pp = &e->next;
    }
}

static int list_length(entry_t const *l) {
    int n = 0;
    for (; l != NULL; l = l->next) {
        if (l < pool || l >= pool + POOL) return -1;
        if (++n > POOL) return -1;
    }
    return n;
}

int main(void) {
    pogobot_init();
    pool_init();
    my_id = pogobot_helper_getid();
    my_tag[0] = my_id & 0xFF; my_tag[1] = my_id >> 8; my_tag[2] = 'N'; my_tag[3] = ~my_tag[0];
    time_reference_t tick;
    uint32_t n = 0;
    pogobot_timer_init(&tick, 50000);

    while (true) {
        pogobot_infrared_update();
        while (pogobot_infrared_message_available()) {
            message_t m;
            pogobot_infrared_recover_next_message(&m);
            uint8_t const *p = m.payload;
            if (m.header.payload_length == 4 && p[2] == 'N' && (uint8_t)~p[0] == p[3])
                note(p[0] | (p[1] << 8), m.header._receiver_ir_index);
        }
        expire();
        if (n % 5 == my_id % 5) pogobot_infrared_sendShortMessage_omni(my_tag, 4);
        n++;

        int used = list_length(used_list), avail = list_length(free_list);
        pogobot_led_setColor(used > 8 ? 25 : 0, used * 3 > 25 ? 25 : used * 3, used == 0 ? 25 : 0);
        if (n % 20 == 0) {
            const char *bad = NULL;
            if (my_id != pogobot_helper_getid() || my_tag[0] != (my_id & 0xFF)) bad = "id";
            else if (used < 0 || avail < 0 || used + avail != POOL) bad = "pool";
            else if (added - expired != (uint32_t)used) bad = "added-expired";
            else if (find(my_id) != NULL) bad = "myself";
            if (bad) printf("SELF BAD id=%u %s\n", pogobot_helper_getid(), bad);
            else printf("SELF ok id=%u neighbours=%d added=%lu expired=%lu\n", my_id, used, (unsigned long)added, (unsigned long)expired);
        }
        pogobot_timer_wait_for_expiry(&tick);
        pogobot_timer_offset_origin_microseconds(&tick, 50000);
    }
}
