/* Uses the LiteX csr accessors of the firmware directly. */
#include "pogobot.h"
#include <generated/csr.h>
#include <stdio.h>

static uint32_t toggles = 0;
static uint16_t id;

static uint32_t raw_time(void) {
    timer0_update_value_write(1);
    return timer0_value_read();
}

int main(void) {
    uint32_t n = 0, last;
    pogobot_init();
    id = pogobot_helper_getid();
    last = raw_time();

    while (1) {
        leds_out_write(leds_out_read() ^ 1u);
        toggles++;
        n++;
        msleep(100);
        if (n % 10 == 0) {
            uint32_t now = raw_time();
            if (toggles != n) printf("SELF BAD id=%u toggles\n", id);
            else printf("SELF ok id=%u toggles=%lu cycles=%lu\n", id, (unsigned long)toggles, (unsigned long)(last - now));
            last = now;
        }
    }
}
