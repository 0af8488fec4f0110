/* Messages of varying length with a CRC32 of our own over id, number, and pattern; the table
 * is computed at start. Sent omniSpe, uniSpe by turns, and raw. */
#include "pogobot.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_BODY 60

static uint32_t crc_table[256];
static uint32_t table_sum;
static uint8_t tx_buf[MAX_BODY + 8];
uint16_t my_id;
uint32_t sequence = 0, ok_count = 0, bad_count = 0, foreign = 0;
static uint32_t last_seq[64];
static uint32_t per_length[MAX_BODY + 1];
static message_t rx;                                  /* one receive buffer, static as stacks are small */

static void make_table(void) {
    for (uint32_t i = 0; i < 256; i++) {
        uint32_t c = i;
        for (int k = 0; k < 8; k++) c = (c & 1) ? 0xEDB88320u ^ (c >> 1) : c >> 1;
        crc_table[i] = c;
    }
}

static uint32_t sum_table(void) {
    uint32_t s = 0;
    for (int i = 0; i < 256; i++) s = s * 31 + crc_table[i];
    return s;
}

static uint32_t crc32_of(uint8_t const *p, int n) {
    uint32_t c = 0xFFFFFFFFu;
    while (n-- > 0) c = crc_table[(c ^ *p++) & 0xFF] ^ (c >> 8);
    return ~c;
}

static uint16_t build(uint8_t *b) {
    int n = 8 + rand() % (MAX_BODY - 8);
    b[0] = my_id & 0xFF; b[1] = my_id >> 8;
    memcpy(b + 2, &sequence, 4);
    for (int i = 6; i < n; i++) b[i] = (uint8_t)(my_id * 31 + sequence * 7 + i);
    uint32_t c = crc32_of(b, n);
    memcpy(b + n, &c, 4);
    return (uint16_t)(n + 4);
}

static void transmit(void) {
    uint16_t len = build(tx_buf);
    switch (sequence % 3) {
        case 0: pogobot_infrared_sendLongMessage_omniSpe(tx_buf, len); break;
        case 1: pogobot_infrared_sendLongMessage_uniSpe((ir_direction)(sequence / 3 % 4), tx_buf, len); break;
        default: {
            message_t m;
            memset(&m.header, 0, sizeof(m.header));
            m.header._emitting_power_list = pogobot_infrared_emitting_power_list_all_full;
            m.header.payload_length = len;
            memcpy(m.payload, tx_buf, len);
            pogobot_infrared_sendRawLongMessage(&m);
        }
    }
    sequence++;
}

static int check_message(message_t const *m) {
    int n = (int)m->header.payload_length - 4;
    uint32_t c, seq;
    if (n < 8 || n > MAX_BODY) { foreign++; return 0; }
    memcpy(&c, m->payload + n, 4);
    memcpy(&seq, m->payload + 2, 4);
    uint16_t from = m->payload[0] | m->payload[1] << 8;
    if (c != crc32_of(m->payload, n) || from != m->header._sender_id || from == my_id) { bad_count++; return 0; }
    for (int i = 6; i < n; i++)
        if (m->payload[i] != (uint8_t)(from * 31 + seq * 7 + i)) { bad_count++; return 0; }
    if (seq < last_seq[from % 64]) bad_count++;       /* never backwards */
    last_seq[from % 64] = seq;
    per_length[n]++;
    ok_count++;
    return 1;
}

int main(void) {
    uint32_t sent = 0, good = 0;
    time_reference_t t;
    pogobot_init();
    make_table();
    table_sum = sum_table();
    my_id = pogobot_helper_getid();
    srand(pogobot_helper_getRandSeed());
    pogobot_infrared_set_power(pogobot_infrared_emitter_power_twoThird);
    pogobot_stopwatch_reset(&t);

    while (1) {
        if (rand() % 100 < 15) { transmit(); sent++; }
        pogobot_infrared_update();
        while (pogobot_infrared_message_available()) {
            pogobot_infrared_recover_next_message(&rx);
            good += check_message(&rx);
        }
        if (pogobot_stopwatch_get_elapsed_microseconds(&t) >= 1000000) {
            uint32_t n = 0;
            pogobot_stopwatch_offset_origin_microseconds(&t, 1000000);
            for (int i = 0; i <= MAX_BODY; i++) n += per_length[i];
            if (my_id != pogobot_helper_getid()) printf("SELF BAD id=%u my_id=%u\n", pogobot_helper_getid(), my_id);
            else if (sum_table() != table_sum) printf("SELF BAD id=%u table\n", my_id);
            else if (sent != sequence || good != ok_count || n != good) printf("SELF BAD id=%u counters\n", my_id);
            else if (bad_count || foreign) printf("SELF BAD id=%u bad=%lu foreign=%lu\n", my_id, (unsigned long)bad_count, (unsigned long)foreign);
            else printf("SELF ok id=%u sent=%lu received=%lu\n", my_id, (unsigned long)sequence, (unsigned long)ok_count);
            pogobot_led_setColors(0, bad_count ? 0 : 20, 0, 1);
        }
        msleep(33);
    }
    return 0;
}
