// The infrared port of a robot, for a firmware.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>

#include "device/arguments.hpp"
#include "device/infrared.hpp"
#include "firmware/firmware_call.hpp"
#include "interface/pogobase_inside.hpp"

namespace pogosim {

namespace {

constexpr std::uint32_t kSent = 0;
constexpr std::uint32_t kNotSent = 1;
constexpr std::uint32_t kFraming = 6;  // bytes around a message on the wire: two at its ends, four of a checksum

using Payload = std::array<std::byte, kMostPayloadBytes>;

std::uint8_t all_faces(FirmwareCall const& call) {
    return faces_of_robot(call.world, call.robot);
}

/// A program may write the variable of the library that mutes the robot.
void look_at_mute(FirmwareCall const& call) {
    if (call.program.is_muted) {
        std::array<std::byte, 1> is_muted{};
        call.read(*call.program.is_muted, is_muted);
        call.world.devices.infrared[call.robot].is_muted = std::to_integer<std::uint8_t>(is_muted[0]);
    }
}

void show_mute(FirmwareCall const& call) {
    if (call.program.is_muted) {
        std::array const is_muted{std::byte{call.world.devices.infrared[call.robot].is_muted}};
        call.write(*call.program.is_muted, is_muted);
    }
}

/// Chance that a robot sends in the time of a tick, for the law of reception.
float send_probability(FirmwareCall const& call) {
    if (!call.program.send_percent) {
        return watched_send_probability(call.world, call.robot);
    }
    constexpr float largest_percentage = 100.0F;
    std::array<std::byte, 1> percent{};
    call.read(*call.program.send_percent, percent);
    return std::min(static_cast<float>(percent[0]), largest_percentage) / largest_percentage;
}

void transmit_timed(FirmwareCall& call, Packet const& packet) {
    if (packet.radiates()) {
        auto const bytes = packet.header_bytes + packet.header.payload_length + kFraming;
        call.time_us += static_cast<double>(call.times.message_byte_us) * bytes;
        transmit(call.world, call.robot, call.out.air, packet, send_probability(call));
    }
}

std::uint32_t put_on_air(FirmwareCall& call, Packet const& packet) {
    look_at_mute(call);
    if (is_muted_for_message(call.world, call.robot)) {
        return kNotSent;
    }
    transmit_timed(call, packet);
    return kSent;
}

/// The payload of a message; nothing, with a warning, for one that cannot be sent.
std::optional<std::span<std::byte const>> read_payload(FirmwareCall const& call, std::uint32_t address,
                                                       std::uint16_t size, Payload& into) {
    if (!is_payload_size(size, call)) {
        return std::nullopt;
    }
    std::span<std::byte> const bytes = std::span(into).first(size);
    call.read(address, bytes);
    return bytes;
}

std::uint32_t send_long(FirmwareCall& call, std::uint8_t emitters, std::uint8_t list, std::uint32_t address,
                        std::uint16_t size) {
    Payload buffer;
    auto const payload = read_payload(call, address, size, buffer);
    return payload ? put_on_air(call, long_packet(call.world, call.robot, emitters, list, *payload, ir_t_user))
                   : kNotSent;
}

std::uint32_t send_long(FirmwareCall& call, std::uint8_t emitters, std::uint32_t address, std::uint16_t size) {
    return send_long(call, emitters, power_list(call.world, call.robot, emitters), address, size);
}

std::uint32_t send_short(FirmwareCall& call, std::uint8_t emitters, std::uint32_t address, std::uint16_t size) {
    Payload buffer;
    auto const payload = read_payload(call, address, size, buffer);
    return payload ? put_on_air(call, short_packet(call.world, call.robot, emitters, *payload)) : kNotSent;
}

/// The emitters of a direction, which is the first argument.
std::uint8_t emitters_of(FirmwareCall const& call) {
    return emitters_of_direction(all_faces(call), call.number(0), call);
}

CallOutcome send_long_to_all(FirmwareCall& call) {
    call.give(send_long(call, all_faces(call), call.argument(0), call.half(1)));
    return CallOutcome::returns;
}

CallOutcome send_long_by_each(FirmwareCall& call) {
    std::uint32_t errors = 0;
    for (unsigned face = 0; face < kMostFaces; ++face) {
        auto const emitter = static_cast<std::uint8_t>(all_faces(call) & 1U << face);
        errors += emitter == 0 ? 0 : send_long(call, emitter, call.argument(0), call.half(1));
    }
    call.give(errors);
    return CallOutcome::returns;
}

CallOutcome send_long_to_one(FirmwareCall& call) {
    call.give(send_long(call, emitters_of(call), call.argument(1), call.half(2)));
    return CallOutcome::returns;
}

CallOutcome send_short_to_all(FirmwareCall& call) {
    call.give(send_short(call, all_faces(call), call.argument(0), call.half(1)));
    return CallOutcome::returns;
}

CallOutcome send_short_to_one(FirmwareCall& call) {
    call.give(send_short(call, emitters_of(call), call.argument(1), call.half(2)));
    return CallOutcome::returns;
}

/// A message with its header, which says with which power each emitter sends.
CallOutcome send_raw_long(FirmwareCall& call) {
    std::uint32_t const message = call.argument(0);
    std::array<std::byte, sizeof(FrameHeader)> bytes{};
    call.read(message, bytes);
    FrameHeader header;
    std::memcpy(&header, bytes.data(), bytes.size());
    header.packet_type = ir_t_user;
    header.sender_id = id_on_air(call.world.robots.id[call.robot]);
    std::memcpy(bytes.data(), &header, bytes.size());
    call.write(message, bytes);
    std::uint8_t const list = header.emitting_power_list;
    std::uint8_t const emitters = emitters_in(call.world, call.robot, list);
    check_emitters(emitters, list, call);
    call.give(send_long(call, emitters, list, message + sizeof(FrameHeader), header.payload_length));
    return CallOutcome::returns;
}

CallOutcome send_raw_short(FirmwareCall& call) {
    std::uint32_t const message = call.argument(1);
    message_short_header_t header;
    std::array<std::byte, sizeof(header)> bytes{};
    call.read(message, bytes);
    std::memcpy(&header, bytes.data(), bytes.size());
    call.give(send_short(call, emitters_of(call), message + sizeof(header), header.payload_length));
    return CallOutcome::returns;
}

/// Bytes of a packet as they are, header first. Since SDK 2.7.1, a fourth argument says how long the payload is, or -1.
CallOutcome send_packet(FirmwareCall& call) {
    constexpr std::uint32_t most_bytes = sizeof(FrameHeader) + kMostPayloadBytes;
    constexpr std::int32_t longest = 65535;
    std::array<std::byte, most_bytes> buffer;
    std::uint32_t const size = call.argument(2);
    if (size > most_bytes) {
        call.note_slip({"the length of the packet", "0 to 390 bytes", "its rest is not sent"}, size);
    }
    std::span<std::byte> const bytes = std::span(buffer).first(std::min(size, most_bytes));
    call.read(call.argument(1), bytes);
    std::int32_t const declared = call.number(3) >= -1 && call.number(3) <= longest ? call.number(3) : -1;
    transmit_timed(call, composed_packet(call.world, call.robot, bytes, declared));
    call.give(0);
    return CallOutcome::returns;
}

CallOutcome set_emitter_power(FirmwareCall& call) {
    check_emitter_power(call.byte(0), call);
    set_ir_power(call.world, call.robot, call.byte(0));
    return CallOutcome::returns;
}

/// The library decodes what has arrived, and obeys the remote control.
CallOutcome update(FirmwareCall& call) {
    if (!call.world.mailboxes.has_commands(call.robot)) {
        return CallOutcome::returns;
    }
    call.self.is_restart_due = obey_commands(call.world, call.robot);
    show_mute(call);
    return call.self.is_restart_due ? CallOutcome::repeats : CallOutcome::returns;
}

CallOutcome has_message(FirmwareCall& call) {
    call.give(call.world.mailboxes.empty(call.robot) ? 0 : 1);
    return CallOutcome::returns;
}

CallOutcome clear_queue(FirmwareCall& call) {
    call.world.mailboxes.clear(call.robot);
    return CallOutcome::returns;
}

CallOutcome take_message(FirmwareCall& call) {
    std::optional<Message> const message = receive(call.world, call.robot);
    if (!message) {
        call.warn_once(kNothingToReceive, std::string(kNothingToReceive));
        return CallOutcome::returns;
    }
    // A program may have made its messages smaller (MAX_PAYLOAD_SIZE_BYTES), so nothing is written behind the payload.
    call.write(call.argument(0), std::as_bytes(std::span(&message->header, 1)));
    call.write(call.argument(0) + sizeof(FrameHeader), message->payload);
    return CallOutcome::returns;
}

CallOutcome get_error_counter(FirmwareCall& call) {
    check_receiver(call.byte(1), call);
    call.write(call.argument(0), std::array<std::byte, sizeof(slip_error_counter_s)>{});
    return CallOutcome::returns;
}

CallOutcome get_drops(FirmwareCall& call) {
    call.give(drops_since_start(call.world, call.robot));
    return CallOutcome::returns;
}

CallOutcome get_malformed(FirmwareCall& call) {
    call.give(malformed_since_start(call.world, call.robot));
    return CallOutcome::returns;
}

CallOutcome initialise(FirmwareCall& call) {
    initialise_infrared(call.world, call.robot);
    show_mute(call);
    return CallOutcome::returns;
}

CallOutcome get_muted(FirmwareCall& call) {
    look_at_mute(call);
    call.give(call.world.devices.infrared[call.robot].is_muted != 0 ? 1 : 0);
    return CallOutcome::returns;
}

}  // namespace

std::span<LibraryFunction const> infrared_functions() {
    static std::array const functions{
        LibraryFunction{"pogobot_infrared_sendLongMessage_omniGen", send_long_to_all, &CallTimes::message_us},
        LibraryFunction{"pogobot_infrared_sendLongMessage_omniSpe", send_long_by_each, &CallTimes::message_us},
        LibraryFunction{"pogobot_infrared_sendLongMessage_uniSpe", send_long_to_one, &CallTimes::message_us},
        LibraryFunction{"pogobot_infrared_sendShortMessage_omni", send_short_to_all, &CallTimes::message_us},
        LibraryFunction{"pogobot_infrared_sendShortMessage_uni", send_short_to_one, &CallTimes::message_us},
        LibraryFunction{"pogobot_infrared_sendRawLongMessage", send_raw_long, &CallTimes::message_us},
        LibraryFunction{"pogobot_infrared_sendRawShortMessage", send_raw_short, &CallTimes::message_us},
        LibraryFunction{"slip_send_message", send_packet, &CallTimes::message_us},
        LibraryFunction{"pogobot_infrared_set_power", set_emitter_power},
        LibraryFunction{"pogobot_infrared_update", update},
        LibraryFunction{"pogobot_infrared_message_available", has_message},
        LibraryFunction{"pogobot_infrared_clear_message_queue", clear_queue},
        LibraryFunction{"pogobot_infrared_recover_next_message", take_message, &CallTimes::receive_us},
        LibraryFunction{"pogobot_infrared_get_receiver_error_counter", get_error_counter},
        LibraryFunction{"pogobot_infrared_reset_receiver_error_counter", do_nothing},
        LibraryFunction{"pogobot_infrared_get_queue_drop_count", get_drops},
        LibraryFunction{"pogobot_infrared_get_malformed_count", get_malformed},
        LibraryFunction{"pogobot_infrared_ll_init", initialise},
        LibraryFunction{"is_muted", get_muted},
        LibraryFunction{"IR_reset_interrupt_flags", do_nothing},
    };
    return functions;
}

}  // namespace pogosim
