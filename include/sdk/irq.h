/// @file
/// Interrupts of the robot. Simulated robots have none, so switching them off and on has no effect.
#ifndef POGOSIM_SDK_IRQ_H
#define POGOSIM_SDK_IRQ_H

#include "pogosim_hardware.h"

#define irq_getie() 1u
#define irq_setie(ie) ((void)(ie))

#ifdef __cplusplus
extern "C" {
#endif
unsigned int irq_getmask(void) POGO_NOT_SIMULATED;
void irq_setmask(unsigned int mask) POGO_NOT_SIMULATED;
unsigned int irq_pending(void) POGO_NOT_SIMULATED;
#ifdef __cplusplus
}
#endif

#endif
