/// @file
/// Registers of the robot's hardware, which are not simulated: a program that uses one does not compile or link.
/// Programs that include this header and use no register run.
#ifndef POGOSIM_SDK_CSR_H
#define POGOSIM_SDK_CSR_H

#include <stdint.h>

#pragma message("registers of the hardware are not simulated: a program that uses one does not compile or link")

#ifdef __cplusplus
extern "C" {
#endif
volatile uint32_t* the_simulator_has_no_hardware_registers(uintptr_t address);
#ifdef __cplusplus
}
#endif

/// A register, by its address.
#define MMPTR(address) (*the_simulator_has_no_hardware_registers((uintptr_t)(address)))

/// Reads and writes a register.
#define csr_read_simple(address) MMPTR(address)
#define csr_write_simple(value, address) ((void)(MMPTR(address) = (value)))

#endif
