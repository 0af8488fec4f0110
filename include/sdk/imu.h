/// @file
/// The inertial measurement unit by the names of its driver. Its registers are not simulated.
#ifndef POGOSIM_SDK_IMU_H
#define POGOSIM_SDK_IMU_H

#include "pogosim_hardware.h"

#define IMU_Init() ((void)0)
/// Three floats each, as of pogobot_imu_read(). They return 0.
#define readAcc(acc)                           \
    __extension__({                            \
        float pogosim_gyro[3];                 \
        pogobot_imu_read((acc), pogosim_gyro); \
        0;                                     \
    })
#define readGyro(gyro)                         \
    __extension__({                            \
        float pogosim_acc[3];                  \
        pogobot_imu_read(pogosim_acc, (gyro)); \
        0;                                     \
    })
#define readTemp() pogobot_imu_readTemp()

#ifdef __cplusplus
extern "C" {
#endif
void IMU_GoToSleep(void) POGO_NOT_SIMULATED;
uint32_t IMU_ReadWord(uint8_t address) POGO_NOT_SIMULATED;
uint8_t IMU_ReadByte(uint8_t address) POGO_NOT_SIMULATED;
void IMU_WriteWord(uint8_t address, uint8_t data) POGO_NOT_SIMULATED;
void IMU_WriteByte(uint8_t address, uint8_t data) POGO_NOT_SIMULATED;
#ifdef __cplusplus
}
#endif

#endif
