/// @file
/// The robot's serial peripheral bus, which is not simulated: its flash is in pogobot.h (read_page_flash() and others).
#ifndef POGOSIM_SDK_SPI_H
#define POGOSIM_SDK_SPI_H

#include "pogosim_hardware.h"

#include <stdio.h>

/// The stored directions of the motors, as of pogobot_motor_dir_mem_get() and pogobot_motor_dir_mem_set().
#define getMotorDirMem(directions) pogobot_motor_dir_mem_get(directions)
#define setMotorDirMem(directions) pogobot_motor_dir_mem_set(directions)
/// The number of the chip: that of the simulated robot.
#define getSerial() ((uint64_t)pogobot_helper_getid())
#define spiUniqueID() getSerial()
#define printSerial() ((void)printf("%llu\n", (unsigned long long)getSerial()))

#define POGO_NO_FLASH_CHIP                                                                 \
    POGO_NOT_SIMULATED_BECAUSE(                                                            \
        "the flash chip is not simulated: call read_page_flash(), write_page_flash() and " \
        "erase_write_section_flash() of pogobot.h, or put it between #ifndef SIMULATOR and #endif")

#ifdef __cplusplus
extern "C" {
#endif
int spiRead(uint32_t addr, uint8_t* data, unsigned int count) POGO_NO_FLASH_CHIP;
int spiWrite(uint32_t addr, uint8_t const* data, unsigned int count) POGO_NO_FLASH_CHIP;
int spiBeginWrite(uint32_t addr, void const* data, unsigned int count) POGO_NO_FLASH_CHIP;
int spiBeginErase4(uint32_t erase_addr) POGO_NO_FLASH_CHIP;
int spiBeginErase32(uint32_t erase_addr) POGO_NO_FLASH_CHIP;
int spiBeginErase64(uint32_t erase_addr) POGO_NO_FLASH_CHIP;
int spiIsBusy(void) POGO_NO_FLASH_CHIP;
uint32_t spiId(void) POGO_NO_FLASH_CHIP;
void spiEnableQuad(void) POGO_NO_FLASH_CHIP;
void spiEraseSecurityRegister(uint8_t reg) POGO_NO_FLASH_CHIP;
int8_t spiWriteSecurityRegister(uint8_t reg, uint8_t addr, uint8_t* data, uint32_t size) POGO_NO_FLASH_CHIP;
int8_t spiReadSecurityRegister(uint8_t reg, uint8_t addr, uint32_t size, uint8_t* buf) POGO_NO_FLASH_CHIP;
int spiInit(void) POGO_NOT_SIMULATED;
uint8_t spiReset(void) POGO_NOT_SIMULATED;
void spiPause(void) POGO_NOT_SIMULATED;
void spiBegin(void) POGO_NOT_SIMULATED;
void spiEnd(void) POGO_NOT_SIMULATED;
void spiFree(void) POGO_NOT_SIMULATED;
void spiHold(void) POGO_NOT_SIMULATED;
void spiUnhold(void) POGO_NOT_SIMULATED;
void spiSwapTxRx(void) POGO_NOT_SIMULATED;
void spi_single_tx(uint8_t out) POGO_NOT_SIMULATED;
uint8_t spi_single_rx(void) POGO_NOT_SIMULATED;
void IMUBegin(void) POGO_NOT_SIMULATED;
void ADCBegin(void) POGO_NOT_SIMULATED;
void IMUADCEnd(void) POGO_NOT_SIMULATED;
#ifdef __cplusplus
}
#endif

#endif
