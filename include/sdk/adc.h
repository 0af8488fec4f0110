/// @file
/// The robot's analogue-to-digital converter, which is not simulated.
#ifndef POGOSIM_SDK_ADC_H
#define POGOSIM_SDK_ADC_H

#include "pogosim_hardware.h"

#ifdef __cplusplus
extern "C" {
#endif
uint32_t ADC_Read(uint8_t channel) POGO_NOT_SIMULATED_BECAUSE(
    "the converter is not simulated: call pogobot_photosensors_read() or pogobot_battery_voltage_read()");
#ifdef __cplusplus
}
#endif

#endif
