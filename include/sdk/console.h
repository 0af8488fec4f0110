/// @file
/// Characters from and to the robot's serial line. To a simulated robot, none are sent.
#ifndef POGOSIM_SDK_CONSOLE_H
#define POGOSIM_SDK_CONSOLE_H

#include "pogosim_hardware.h"

#include <stdio.h>

#include "uart.h"

#define readchar() uart_read()
#define readchar_nonblock() uart_read_nonblock()
/// Prints a text, without the end of a line.
#define putsnonl(text) ((void)printf("%s", (text)))

#endif
