/// @file
/// Versions of what the robot's hardware was made with.
#ifndef POGOSIM_SDK_GIT_H
#define POGOSIM_SDK_GIT_H

#define MIGEN_GIT_SHA1 "--------"
#define LITEX_GIT_SHA1 "--------"

#endif
