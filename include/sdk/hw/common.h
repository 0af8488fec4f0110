/// @file
/// What programs include for the registers of the hardware, see generated/csr.h.
#ifndef POGOSIM_SDK_HW_COMMON_H
#define POGOSIM_SDK_HW_COMMON_H

#include "generated/csr.h"

#endif
