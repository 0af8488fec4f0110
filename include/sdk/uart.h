/// @file
/// The robot's serial line. What a robot writes is printed; to a simulated robot, nothing is sent.
#ifndef POGOSIM_SDK_UART_H
#define POGOSIM_SDK_UART_H

#include "pogosim_hardware.h"

/// Whether a character waits to be read: none ever does.
#define uart_read_nonblock() 0
/// Waits for a character, which never comes.
#define uart_read() pogosim_read_character()
#ifndef REAL_ROBOT
#define uart_write(character) ((void)pogosim_putchar(character))
#endif
#define uart_init() ((void)0)
#define uart_sync() ((void)0)

#ifdef __cplusplus
extern "C" {
#endif
#ifdef REAL_ROBOT
void uart_write(char c);
#endif
void msleep(int milliseconds);
static inline __attribute__((unused)) char pogosim_read_character(void) {
    for (;;) {
        msleep(1000);
    }
    return 0;  // some compilers want it
}
void uart_isr(void) POGO_NOT_SIMULATED;
#ifdef __cplusplus
}
#endif

#endif
