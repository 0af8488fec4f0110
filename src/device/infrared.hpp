// The infrared port of a robot: what it sends is put on the air, and comms delivers it after every robot has run; what
// it receives waits in its mailbox.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "interface/pogobase_inside.hpp"
#include "world/world.hpp"

namespace pogosim {

// What a robot's library does with packets before its program sees them: it obeys commands of the remote control, which
// mute, unmute and restart robots, and counts what it cannot pass on.

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

// What programs send and receive.

inline constexpr std::uint8_t kMostIrPower = 3;

/// Said once to a program that takes a message where there is none.
inline constexpr std::string_view kNothingToReceive =
    "pogobot_infrared_recover_next_message was called with no message waiting: check "
    "pogobot_infrared_message_available() first";

/// What a robot sends. Emitters: bit d is emitter d.
struct Packet {
    std::uint8_t emitters = kAllFaces;
    std::uint8_t power = 0;  // 0 to kMostIrPower; 0 sends nothing
    PacketKind kind = PacketKind::message;
    FrameHeader header{};            // payload_length: that of the payload
    std::uint16_t header_bytes = 0;  // as the law of reception counts them
    std::span<std::byte const> payload{};

    bool radiates() const { return emitters != 0 && power != 0; }
};

/// Bit d: the robot has face d. The global step, which is no robot, counts as one that has all.
inline std::uint8_t faces_of_robot(World const& world, std::size_t device) {
    return device < world.robots.size() ? world.spec_of(device).model.face_bits() : kAllFaces;
}

/// A long message of this type, by a list of the emitters' powers, as receivers see it.
Packet long_packet(World const& world, std::uint32_t robot, std::uint8_t emitters, std::uint8_t power_list,
                   std::span<std::byte const> payload, std::uint8_t type);

/// A short message, whose header says neither sender nor emitter, at the power of the robot's port.
Packet short_packet(World const& world, std::size_t device, std::uint8_t emitters, std::span<std::byte const> payload);

/// A packet as a program has composed it of bytes, header first: what robots cannot read is malformed.
/// `declared_length`: bytes of its payload as the sender has said, or negative.
Packet composed_packet(World const& world, std::size_t device, std::span<std::byte const> bytes,
                       std::int64_t declared_length);

// Lists of powers have two bits for each emitter.

/// The list that drives these emitters with the power of the robot's port.
inline std::uint8_t power_list(World const& world, std::size_t device, std::uint8_t emitters) {
    constexpr std::array<std::uint8_t, kAllFaces + 1> ones{0x00, 0x01, 0x04, 0x05, 0x10, 0x11, 0x14, 0x15,
                                                           0x40, 0x41, 0x44, 0x45, 0x50, 0x51, 0x54, 0x55};
    return static_cast<std::uint8_t>(ones[emitters & kAllFaces] * world.devices.ir_power[device]);
}

/// The largest power of a list; emitters of different power are not told apart.
constexpr std::uint8_t highest_power(std::uint8_t list) {
    bool const has_three = (list & list >> 1U & 0x55U) != 0;
    bool const has_two = (list & 0xAAU) != 0;
    bool const has_one = list != 0;
    return has_three ? 3 : has_two ? 2 : has_one ? 1 : 0;
}

/// Emitters of the robot with a power that is not 0.
std::uint8_t emitters_in(World const& world, std::size_t device, std::uint8_t list);

/// Chance that a robot sends in the time of a tick, for the law of reception, where no main loop knows it: what it has
/// done in the last second or two. Counts this time as one at which it sends.
float watched_send_probability(World& world, std::uint32_t robot);

/// Puts a packet that radiates on the air, and counts it. `air`: World::air, or that of the
/// robot's part of the swarm.
void transmit(World& world, std::uint32_t robot, TransmissionQueue& air, Packet const& packet, float send_probability);

/// Whether a robot is muted; counts a message that is not sent because of that.
inline bool is_muted_for_message(World& world, std::size_t device) {
    InfraredState& infrared = world.devices.infrared[device];
    if (infrared.is_muted == 0) [[likely]] {
        return false;
    }
    ++infrared.muted_messages;
    return true;
}

/// Powers above kMostIrPower count as that.
void set_ir_power(World& world, std::size_t device, std::uint8_t power);

/// Range of a message that this robot sends at its present emitter power, mm; 0 if it is switched off.
float ir_range_mm(World const& world, std::uint32_t robot);

/// Takes the oldest message out of the robot's mailbox. Absent: there is none.
inline std::optional<Message> receive(World& world, std::uint32_t robot) {
    std::optional<Message> const message = world.mailboxes.take(robot);
    world.devices.messages_received[robot] += message ? 1 : 0;
    return message;
}

}  // namespace pogosim
