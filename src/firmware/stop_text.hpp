// Why a firmware cannot go on, for messages.
#pragma once

#include <string>

#include "firmware/firmware_call.hpp"
#include "riscv/core.hpp"

namespace pogosim {

/// "it jumped to 0x00000000, where there is no code: ...". For reasons that a program can be blamed for.
std::string text_of(Stop const& stop, FirmwareRobot const& robot, Firmware const& firmware);

std::string text_of(WrongAddress const& wrong);

/// Whether a robot has called a function that the simulator has no code for, see emu/stubs.S.
bool is_without_code(FirmwareRobot const& robot);

}  // namespace pogosim
