// What a robot's library does with infrared packets before its program sees them: it obeys commands of the remote
// control, which mute, unmute and restart robots, and counts what it cannot pass on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "world/mailbox.hpp"

namespace pogosim {

/// The infrared state of one robot. Initialising the hardware makes it anew, but for the counts of the whole run.
struct InfraredState {
    std::uint8_t is_muted = 0;           // not 0: functions that send return an error; the program may write it, too
    std::uint64_t dropped_before = 0;    // Mailboxes::dropped() when it was initialised
    std::uint64_t malformed_before = 0;  // Mailboxes::malformed() then
    std::uint64_t muted_messages = 0;    // that were not sent, in the whole run
    std::uint32_t restarts = 0;          // in the whole run
};

/// Command, or not: a packet is one if its type is ir_t_cmd and its payload begins with DEADCAFE, BASECAFE or DEADBEEF.
PacketKind kind_of_packet(FrameHeader const& header, std::span<std::byte const> payload);

/// The robot's library decodes what has arrived: it is muted or unmuted. Returns whether it is to restart.
bool obey_commands(Mailboxes& mailboxes, std::size_t robot, InfraredState& state);

/// The robot's infrared hardware is initialised: it is not muted, its counters are 0, and its queue is empty.
void initialise_infrared(Mailboxes& mailboxes, std::size_t robot, InfraredState& state);

/// Messages lost to a full queue, and malformed ones, since it was initialised.
std::uint32_t drops_since_start(Mailboxes const& mailboxes, std::size_t robot, InfraredState const& state);
std::uint32_t malformed_since_start(Mailboxes const& mailboxes, std::size_t robot, InfraredState const& state);

}  // namespace pogosim
