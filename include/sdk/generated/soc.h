/// @file
/// Constants of the robot's processor.
#ifndef POGOSIM_SDK_SOC_H
#define POGOSIM_SDK_SOC_H

#define CONFIG_CLOCK_FREQUENCY 21000000

#endif
