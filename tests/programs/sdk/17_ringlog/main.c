/* Logging to a ring buffer through a variadic function; the log is printed at the end, and
 * main() returns after 20 s. */
#include "pogobot.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINES 16
#define WIDTH 48

static char ring[LINES][WIDTH];
static unsigned head = 0, stored = 0;
static uint32_t bytes_logged = 0;
static int verbosity = 2;
static uint16_t id;
static time_reference_t start;
static struct { uint32_t ms; int16_t light; int16_t battery; } last;

static int log_line(int level, const char *fmt, ...) {
    va_list ap;
    if (level > verbosity) return 0;
    char *dst = ring[head % LINES];
    int n = snprintf(dst, WIDTH, "%u|", id);
    va_start(ap, fmt);
    n += vsnprintf(dst + n, WIDTH - n, fmt, ap);
    va_end(ap);
    if (n >= WIDTH) n = WIDTH - 1;
    head++;
    if (stored < LINES) stored++;
    bytes_logged += (uint32_t)n;
    return n;
}

static uint32_t now_ms(void) { return (uint32_t)pogobot_stopwatch_get_elapsed_microseconds(&start) / 1000; }

/* prints its parts one by one: the line is only complete with the last printf */
static void say(int ok, const char *fmt, ...) {
    char buf[64];
    va_list ap;
    printf("SELF ");
    printf(ok ? "ok " : "BAD ");
    printf("id=%u ", pogobot_helper_getid());
    msleep(3);
    va_start(ap, fmt);
    vsnprintf(buf, sizeof buf, fmt, ap);
    va_end(ap);
    printf("%s\n", buf);
}

static int ring_is_mine(void) {
    for (unsigned i = 0; i < stored; i++) {
        char *bar;
        unsigned long v = strtoul(ring[i], &bar, 10);
        if (*bar != '|' || v != id) return 0;
    }
    return 1;
}

int main(void) {
    uint32_t bytes = 0;
    unsigned lines = 0, seconds = 0;
    pogobot_init();
    id = pogobot_helper_getid();
    pogobot_stopwatch_reset(&start);
    int r = log_line(1, "boot seed=%d", pogobot_helper_getRandSeed());
    bytes += r; lines++;

    while (seconds < 20) {
        for (int i = 0; i < 10; i++) {
            last.ms = now_ms();
            last.light = pogobot_photosensors_read(i % 3);
            last.battery = pogobot_battery_voltage_read();
            r = log_line(2, "t=%lu light[%d]=%d bat=%d", (unsigned long)last.ms, i % 3, last.light, last.battery);
            bytes += r; lines++;
            r = log_line(3, "not shown %s %f", "at all", 1.5);
            bytes += r;
            pogobot_led_setColors(i, 0, 10 - i, 0);
            msleep(i == 9 ? 97 : 100);
        }
        seconds++;
        if (id != pogobot_helper_getid()) say(0, "id was %u", id);
        else if (head != lines || bytes_logged != bytes) say(0, "head %u lines %u", head, lines);
        else if (!ring_is_mine()) say(0, "ring");
        else if (stored != (lines < LINES ? lines : LINES)) say(0, "stored");
        else say(1, "lines=%u bytes=%lu t=%lu", lines, (unsigned long)bytes, (unsigned long)now_ms());
    }
    for (unsigned i = head - stored; i != head; i++) printf("LOG %s\n", ring[i % LINES]);
    pogobot_led_setColor(0, 0, 0);
    printf("END id=%u after %lu ms\n", id, (unsigned long)now_ms());
    return 0;
}
