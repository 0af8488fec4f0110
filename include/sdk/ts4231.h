/// @file
/// The robot's light-to-digital converters, which are not simulated: light is in pogobot_photosensors_read().
#ifndef POGOSIM_SDK_TS4231_H
#define POGOSIM_SDK_TS4231_H

#include "pogosim_hardware.h"

#include <stdbool.h>

#define POGO_NO_LIGHTHOUSE_SENSOR \
    POGO_NOT_SIMULATED_BECAUSE("the light-to-digital converter is not simulated: call pogobot_photosensors_read()")

#ifdef __cplusplus
extern "C" {
#endif
bool ts_waitForLight(uint8_t index, uint16_t light_timeout) POGO_NO_LIGHTHOUSE_SENSOR;
bool ts_goToSleep(uint8_t index) POGO_NO_LIGHTHOUSE_SENSOR;
bool ts_goToWatch(uint8_t index) POGO_NO_LIGHTHOUSE_SENSOR;
void ts_delayUs(unsigned int delay_val) POGO_NO_LIGHTHOUSE_SENSOR;
uint8_t ts_configDevice(uint8_t index, uint16_t config_val) POGO_NO_LIGHTHOUSE_SENSOR;
void ts_writeConfig(uint8_t index, uint16_t config_val) POGO_NO_LIGHTHOUSE_SENSOR;
uint16_t ts_readConfig(uint8_t index) POGO_NO_LIGHTHOUSE_SENSOR;
uint8_t ts_checkBus(uint8_t index) POGO_NO_LIGHTHOUSE_SENSOR;
#ifdef __cplusplus
}
#endif

#endif
