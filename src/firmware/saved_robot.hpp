// The state of a robot that runs firmware as bytes: for hashes, and to go on from there.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "firmware/firmware_robot.hpp"

namespace pogosim {

void save_robot(FirmwareRobot const& robot, std::vector<std::byte>& bytes);

/// Takes the bytes of one robot from the front of `bytes`. `robot`: as it is at the start of a run.
void restore_robot(FirmwareRobot& robot, std::span<std::byte const>& bytes);

}  // namespace pogosim
