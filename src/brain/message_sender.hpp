// Long messages of robots that no program drives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "world/world.hpp"

namespace pogosim {

/// Sends a message of up to kMostPayloadBytes through these emitters (bit d: emitter d) at the power of the robot's
/// port, unless the robot is muted.
void send_message(World& world, std::uint32_t robot, std::uint8_t emitters, std::span<std::byte const> payload);

}  // namespace pogosim
