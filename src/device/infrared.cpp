#include "device/infrared.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "device/clock.hpp"
#include "interface/pogobase_inside.hpp"

namespace pogosim {

namespace {

using namespace std::string_view_literals;

constexpr std::array<std::pair<std::string_view, PacketKind>, 3> kCommands{
    {{"DEADCAFE"sv, PacketKind::mute}, {"BASECAFE"sv, PacketKind::unmute}, {"DEADBEEF"sv, PacketKind::restart}}};

}  // namespace

PacketKind kind_of_command(std::span<std::byte const> payload) {
    std::string_view const text(reinterpret_cast<char const*>(payload.data()), payload.size());
    for (auto const& [command, kind] : kCommands) {
        if (text.starts_with(command)) {
            return kind;
        }
    }
    return PacketKind::message;
}

bool obey_commands(World& world, std::uint32_t robot) {
    Mailboxes::Commands const commands = world.mailboxes.take_commands(robot);
    if (commands.is_muted) {
        world.devices.infrared[robot].is_muted = *commands.is_muted ? 1 : 0;
    }
    return commands.restart;
}

void initialise_infrared(World& world, std::uint32_t robot) {
    InfraredState& state = world.devices.infrared[robot];
    world.mailboxes.clear(robot);
    state.is_muted = 0;
    state.dropped_before = world.mailboxes.dropped(robot);
    state.malformed_before = world.mailboxes.malformed(robot);
}

std::uint32_t drops_since_start(World const& world, std::uint32_t robot) {
    return static_cast<std::uint32_t>(world.mailboxes.dropped(robot) - world.devices.infrared[robot].dropped_before);
}

std::uint32_t malformed_since_start(World const& world, std::uint32_t robot) {
    return static_cast<std::uint32_t>(world.mailboxes.malformed(robot) -
                                      world.devices.infrared[robot].malformed_before);
}

namespace {

// The article's library adds these to a message's size: 3 bytes in front of a short payload, 8 in front of a long one.
constexpr std::uint16_t kShortHeaderBytes = 3;
constexpr std::uint16_t kLongHeaderBytes = 8;

// What a receiver sees of a short message.
constexpr std::uint16_t kNoSender = 0xFF;
constexpr std::uint8_t kNoSenderIndex = 0xF;

static_assert(sizeof(FrameHeader) == sizeof(message_header_t));
static_assert(kMostPayloadBytes == MAX_PAYLOAD_SIZE_BYTES);
static_assert(kMostIrPower == pogobot_infrared_emitter_power_max);

/// The emitter index that receivers see: 4 for several that are all the robot has, otherwise the first one.
std::uint8_t sender_index(std::uint8_t emitters, std::uint8_t all) {
    bool const is_several = (emitters & (emitters - 1U)) != 0;
    bool const is_all = emitters == all && is_several;
    return is_all ? static_cast<std::uint8_t>(ir_all)
                  : static_cast<std::uint8_t>(__builtin_ctz(emitters | 1U << kMostFaces));
}

}  // namespace

Packet long_packet(World const& world, std::uint32_t robot, std::uint8_t emitters, std::uint8_t power_list,
                   std::span<std::byte const> payload, std::uint8_t type) {
    FrameHeader const header{.packet_type = type,
                             .emitting_power_list = power_list,
                             .sender_id = robot == kNone ? std::uint16_t{0} : id_on_air(world.robots.id[robot]),
                             .sender_ir_index = sender_index(emitters, faces_of_robot(world, robot)),
                             .receiver_ir_index = 0,
                             .payload_length = static_cast<std::uint16_t>(payload.size())};
    return {.emitters = emitters,
            .power = highest_power(power_list),
            .kind = kind_of_packet(header, payload),
            .header = header,
            .header_bytes = kLongHeaderBytes,
            .payload = payload};
}

Packet short_packet(World const& world, std::size_t device, std::uint8_t emitters, std::span<std::byte const> payload) {
    return {.emitters = emitters,
            .power = world.devices.ir_power[device],
            .header = {.packet_type = ir_t_short,
                       .emitting_power_list = 0,
                       .sender_id = kNoSender,
                       .sender_ir_index = kNoSenderIndex,
                       .receiver_ir_index = 0,
                       .payload_length = static_cast<std::uint16_t>(payload.size())},
            .header_bytes = kShortHeaderBytes,
            .payload = payload};
}

Packet composed_packet(World const& world, std::size_t device, std::span<std::byte const> bytes,
                       std::int64_t declared_length) {
    bool const is_short = !bytes.empty() && bytes[0] == std::byte{ir_t_short};
    std::size_t const header_bytes = is_short ? sizeof(message_short_header_t) : sizeof(message_header_t);
    FrameHeader header{.packet_type = ir_t_short, .sender_id = kNoSender, .sender_ir_index = kNoSenderIndex};
    if (bytes.size() >= header_bytes && is_short) {
        message_short_header_t given;
        std::memcpy(&given, bytes.data(), header_bytes);
        header.payload_length = given.payload_length;
    } else if (bytes.size() >= header_bytes) {
        std::memcpy(&header, bytes.data(), header_bytes);
    }
    std::uint8_t const list = is_short || header.emitting_power_list == 0
                                  ? power_list(world, device, faces_of_robot(world, device))
                                  : header.emitting_power_list;
    std::size_t const payload_bytes = bytes.size() - std::min(bytes.size(), header_bytes);
    bool const is_whole = bytes.size() >= header_bytes && header.payload_length == payload_bytes &&
                          (declared_length < 0 || declared_length == header.payload_length) &&
                          payload_bytes <= MAX_PAYLOAD_SIZE_BYTES;
    auto const payload = bytes.last(payload_bytes).first(std::min<std::size_t>(payload_bytes, MAX_PAYLOAD_SIZE_BYTES));
    header.payload_length = static_cast<std::uint16_t>(payload.size());
    return {.emitters = emitters_in(world, device, list),
            .power = highest_power(list),
            .kind = is_whole ? kind_of_packet(header, payload) : PacketKind::malformed,
            .header = header,
            .header_bytes = is_short ? kShortHeaderBytes : kLongHeaderBytes,
            .payload = payload};
}

std::uint8_t emitters_in(World const& world, std::size_t device, std::uint8_t list) {
    std::uint8_t emitters = 0;
    for (unsigned face = 0; face < kMostFaces; ++face) {
        if (get_infrared_emitter_dir(face, list) != 0) {
            emitters = static_cast<std::uint8_t>(emitters | 1U << face);
        }
    }
    return static_cast<std::uint8_t>(emitters & faces_of_robot(world, device));
}

float watched_send_probability(World& world, std::uint32_t robot) {
    constexpr std::int64_t window_us = 1000000;
    std::int64_t const now_us = world.devices.clock_us[robot];
    SentRate& rate = world.devices.sent_rate[robot];
    if (now_us - rate.began_us >= window_us) {
        rate = {.before_us = rate.began_us, .began_us = now_us, .before = rate.present};
    }
    rate.present += now_us != std::exchange(rate.last_us, now_us) ? 1 : 0;
    std::int64_t const watched_us = now_us - rate.before_us + kUsualTickUs;
    return std::min(1.0F, static_cast<float>(rate.before + rate.present) * static_cast<float>(kUsualTickUs) /
                              static_cast<float>(watched_us));
}

void transmit(World& world, std::uint32_t robot, TransmissionQueue& air, Packet const& packet, float send_probability) {
    ++world.devices.messages_sent[robot];
    air.transmissions.push_back(
        {.robot = robot,
         .emitters = packet.emitters,
         .kind = packet.kind,
         .message_bytes = static_cast<std::uint16_t>(packet.header_bytes + packet.header.payload_length),
         .send_probability = send_probability,
         .range_mm = world.spec_of(robot).ir.range_at_mm(packet.power),
         .header = packet.header,
         .payload_offset = air.payloads.size()});
    air.payloads.insert(air.payloads.end(), packet.payload.begin(), packet.payload.end());
}

void set_ir_power(World& world, std::size_t device, std::uint8_t power) {
    world.devices.ir_power[device] = std::min(power, kMostIrPower);
}

float ir_range_mm(World const& world, std::uint32_t robot) {
    return is_alive(world, robot) ? world.spec_of(robot).ir.range_at_mm(world.devices.ir_power[robot]) : 0.0F;
}

}  // namespace pogosim
