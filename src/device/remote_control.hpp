// What a robot's library does with infrared packets before its program sees them: it obeys commands of the remote
// control, which mute, unmute and restart robots, and counts what it cannot pass on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "interface/pogobase_inside.hpp"
#include "world/world.hpp"

namespace pogosim {

/// What a packet of type ir_t_cmd with this payload is: a command if it begins with DEADCAFE, BASECAFE or DEADBEEF.
PacketKind kind_of_command(std::span<std::byte const> payload);

/// Command, or not.
inline PacketKind kind_of_packet(FrameHeader const& header, std::span<std::byte const> payload) {
    return header.packet_type == ir_t_cmd ? kind_of_command(payload) : PacketKind::message;
}

/// The robot's library decodes what has arrived: it is muted or unmuted. Returns whether it is to restart.
bool obey_commands(World& world, std::uint32_t robot);

/// The robot's infrared hardware is initialised: it is not muted, its counters are 0, and its queue is empty.
void initialise_infrared(World& world, std::uint32_t robot);

/// Messages lost to a full queue, and malformed ones, since it was initialised.
std::uint32_t drops_since_start(World const& world, std::uint32_t robot);
std::uint32_t malformed_since_start(World const& world, std::uint32_t robot);

}  // namespace pogosim
