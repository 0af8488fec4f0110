/* Blinks by writing to the register of the LED peripheral at its address. */
#include "pogobot.h"
#include <stdint.h>
#include <stdio.h>

#define LED_REG   (*(volatile uint32_t *)0xf0002800u)
#define TIMER_EN  (*(volatile uint32_t *)0xf0003808u)

static uint16_t id;
static uint32_t count;

int main(void) {
    uint32_t n = 0;
    pogobot_init();
    id = pogobot_helper_getid();
    TIMER_EN = 1;
    for (;;) {
        LED_REG = n & 1;
        count++;
        n++;
        msleep(500);
        if (n % 2 == 0) {
            if (count != n || id != pogobot_helper_getid()) printf("SELF BAD id=%u count\n", id);
            else printf("SELF ok id=%u led=%lu\n", id, (unsigned long)LED_REG);
        }
    }
}
