/// @file
/// The magnetometer of the robots' SDK 2.7, for programs that include it by name. Its registers have names here, but
/// there is no SPI link through which a simulated program could read them.
#ifndef POGOSIM_SDK_MAGNETOMETER_H
#define POGOSIM_SDK_MAGNETOMETER_H

#ifndef POGOBASE_H
#include <pogobot.h>  // of firmware, another one
#endif
#include <math.h>

///@{
/// Registers of the LIS2MDL (STMicroelectronics, data sheet DS12144).
#define LIS2MDL_OFFSET_X_REG_L 0x45
#define LIS2MDL_OFFSET_X_REG_H 0x46
#define LIS2MDL_OFFSET_Y_REG_L 0x47
#define LIS2MDL_OFFSET_Y_REG_H 0x48
#define LIS2MDL_OFFSET_Z_REG_L 0x49
#define LIS2MDL_OFFSET_Z_REG_H 0x4A
#define LIS2MDL_WHO_AM_I 0x4F
#define LIS2MDL_CFG_REG_A 0x60
#define LIS2MDL_CFG_REG_B 0x61
#define LIS2MDL_CFG_REG_C 0x62
#define LIS2MDL_INT_CRTL_REG 0x63
#define LIS2MDL_INT_SOURCE_REG 0x64
#define LIS2MDL_INT_THS_L_REG 0x65
#define LIS2MDL_INT_THS_H_REG 0x66
#define LIS2MDL_STATUS_REG 0x67
#define LIS2MDL_OUTX_L_REG 0x68
#define LIS2MDL_OUTX_H_REG 0x69
#define LIS2MDL_OUTY_L_REG 0x6A
#define LIS2MDL_OUTY_H_REG 0x6B
#define LIS2MDL_OUTZ_L_REG 0x6C
#define LIS2MDL_OUTZ_H_REG 0x6D
#define LIS2MDL_TEMP_OUT_L_REG 0x6E
#define LIS2MDL_TEMP_OUT_H_REG 0x6F
///@}

///@{
/// Values in them.
#define LIS2MDL_SPI_READ_MASK 0x80
#define LIS2MDL_WHO_AM_I_VALUE 0x40
#define LIS2MDL_STATUS_XDA 0x01
#define LIS2MDL_STATUS_YDA 0x02
#define LIS2MDL_STATUS_ZDA 0x04
#define LIS2MDL_STATUS_ZYXDA 0x08
///@}

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

/// Looks for the magnetometer and sets it up, as magn_init() does, which has replaced it. 0: it is there, 1: it is not.
uint8_t magn_check(void);

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
