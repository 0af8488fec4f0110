/// @file
/// The robot's memory map, which is not simulated: a program that uses an address of it does not compile.
#ifndef POGOSIM_SDK_MEM_H
#define POGOSIM_SDK_MEM_H

#include "pogosim_hardware.h"

#ifdef __cplusplus
extern "C" {
#endif
uintptr_t the_simulator_has_no_memory_map(void) POGO_NOT_SIMULATED;
#ifdef __cplusplus
}
#endif

#define ROM_BASE the_simulator_has_no_memory_map()
#define ROM_SIZE the_simulator_has_no_memory_map()
#define SRAM_BASE the_simulator_has_no_memory_map()
#define SRAM_SIZE the_simulator_has_no_memory_map()
#define SPIFLASH_BASE the_simulator_has_no_memory_map()
#define SPIFLASH_SIZE the_simulator_has_no_memory_map()
#define CSR_BASE the_simulator_has_no_memory_map()
#define CSR_SIZE the_simulator_has_no_memory_map()

#endif
