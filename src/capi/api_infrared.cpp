// pogolib/infrared.h: messages sent by user code are put on the air; comms delivers them after every robot has run.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "base/log.hpp"
#include "device/infrared.hpp"
#include "pogosim/program.h"
#include "process/crash_handler.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"
#include "robot/controllers.hpp"
#include "robot/function_times.hpp"
#include "robot/robot_floating_point.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::FrameHeader;
using pogosim::kind_of_packet;
using pogosim::kMostFaces;
using pogosim::kNothingSent;
using pogosim::note_slip;
using pogosim::NoteSlip;
using pogosim::Packet;
using pogosim::PacketKind;
using pogosim::require_argument;
using pogosim::require_robot;

namespace {

constexpr std::uint32_t kSent = 0;
constexpr std::uint32_t kNotSent = 1;
constexpr auto kMessage = "the address of a message";

std::span<std::byte const> bytes_of(std::uint8_t const* data, std::size_t size) {
    return std::as_bytes(std::span(data, size));
}

/// Chance that a robot sends in the time of a tick, for the article's law of reception. In an endless loop in main(),
/// it is what the robot has done in the last second or two.
float send_probability() {
    constexpr float largest_percentage = 100.0F;
    if (context.phase != pogosim::Phase::main) {
        return std::min<float>(percent_msgs_sent_per_ticks, largest_percentage) / largest_percentage;
    }
    return pogosim::watched_send_probability(*context.world, context.robot);
}

/// Puts one transmission on the air. Robots that receive it pass a packet on unless it is malformed.
inline void transmit(Packet const& packet) {
    pogosim::note_call();
    if (context.has_robot() && packet.radiates()) {
        pogosim::take_back_floating_point();
        pogosim::transmit(*context.world, context.robot, pogosim::current_air(), packet, send_probability());
    }
}

/// False, with a message, for a message that cannot be sent.
bool is_message(char const* function, std::uint8_t const* payload, std::uint16_t size) {
    if (!pogosim::is_payload_size(size, NoteSlip{function})) {
        return false;
    }
    if (payload == nullptr && size > 0) [[unlikely]] {
        note_slip({function, "message", kMessage, kNothingSent}, "NULL");
        return false;
    }
    return true;
}

/// Sends a packet unless the robot is muted.
inline std::uint32_t put_on_air(Packet const& packet) {
    if (pogosim::is_muted_for_message(*context.world, context.device)) [[unlikely]] {
        pogosim::note_call();
        return kNotSent;
    }
    transmit(packet);
    return kSent;
}

std::uint8_t own_faces() {
    return pogosim::faces_of_robot(*context.world, context.device);
}

std::uint8_t emitters_of(char const* function, ir_direction direction) {
    return pogosim::emitters_of_direction(own_faces(), direction, NoteSlip{function});
}

std::uint8_t own_power_list(std::uint8_t emitters) {
    return pogosim::power_list(*context.world, context.device, emitters);
}

std::uint32_t send_long(char const* function, std::uint8_t emitters, std::uint8_t list, std::uint8_t const* payload,
                        std::uint16_t size, std::uint8_t type = ir_t_user) {
    if (!is_message(function, payload, size)) {
        return kNotSent;
    }
    return put_on_air(
        pogosim::long_packet(*context.world, context.robot, emitters, list, bytes_of(payload, size), type));
}

/// A raw message that is a command. Real robots send it as a message of users: their remote control sends commands.
bool is_command_of_remote_control(message_t const& message) {
    auto const header = std::bit_cast<FrameHeader>(message.header);
    std::size_t const size = std::min<std::size_t>(header.payload_length, MAX_PAYLOAD_SIZE_BYTES);
    if (kind_of_packet(header, std::as_bytes(std::span(message.payload, size))) == PacketKind::message) [[likely]] {
        return false;
    }
    context.services->warn_once(
        "pogobot_infrared_sendRawLongMessage() sends a command (type ir_t_cmd), which robots that hear it obey; a real "
        "robot would send it as a message of type ir_t_user: there, commands come from the remote control");
    return true;
}

std::uint32_t send_short(char const* function, std::uint8_t emitters, std::uint8_t const* payload, std::uint16_t size) {
    if (!is_message(function, payload, size)) {
        return kNotSent;
    }
    return put_on_air(pogosim::short_packet(*context.world, context.device, emitters, bytes_of(payload, size)));
}

}  // namespace

struct pogosim_slip_descriptor const slip_send_descriptor = {};

uint32_t pogobot_infrared_sendLongMessage_omniGen(uint8_t* const message, uint16_t const message_size) {
    require_robot(__func__);
    std::uint8_t const all = own_faces();
    return send_long(__func__, all, own_power_list(all), message, message_size);
}

uint32_t pogobot_infrared_sendLongMessage_omniSpe(uint8_t* const message, uint16_t const message_size) {
    require_robot(__func__);
    uint32_t errors = 0;
    for (unsigned face = 0; face < kMostFaces; ++face) {
        auto const emitter = static_cast<std::uint8_t>(1U << face);
        if ((own_faces() & emitter) == 0) {
            continue;
        }
        errors += send_long(__func__, emitter, own_power_list(emitter), message, message_size);
    }
    return errors;
}

uint32_t pogobot_infrared_sendLongMessage_uniSpe(ir_direction dir, uint8_t* const message,
                                                 uint16_t const message_size) {
    require_robot(__func__);
    std::uint8_t const emitters = emitters_of(__func__, dir);
    return send_long(__func__, emitters, own_power_list(emitters), message, message_size);
}

uint32_t pogobot_infrared_sendShortMessage_omni(uint8_t* const message, uint16_t const message_size) {
    require_robot(__func__);
    return send_short(__func__, own_faces(), message, message_size);
}

uint32_t pogobot_infrared_sendShortMessage_uni(ir_direction dir, uint8_t* const message, uint16_t const message_size) {
    require_robot(__func__);
    return send_short(__func__, emitters_of(__func__, dir), message, message_size);
}

uint32_t pogobot_infrared_sendRawLongMessage(message_t* const message) {
    require_robot(__func__);
    if (message == nullptr) [[unlikely]] {
        note_slip({__func__, "message", kMessage, kNothingSent}, "NULL");
        return kNotSent;
    }
    bool const is_command = is_command_of_remote_control(*message);
    message->header._packet_type = is_command ? ir_t_cmd : ir_t_user;
    message->header._sender_id = pogobot_helper_getid();
    std::uint8_t const list = message->header._emitting_power_list;
    std::uint8_t const emitters = pogosim::emitters_in(*context.world, context.device, list);
    pogosim::check_emitters(emitters, list, NoteSlip{__func__});
    return send_long(__func__, emitters, list, message->payload, message->header.payload_length,
                     message->header._packet_type);
}

uint32_t pogobot_infrared_sendRawShortMessage(ir_direction dir, short_message_t* const message) {
    require_robot(__func__);
    if (message == nullptr) [[unlikely]] {
        note_slip({__func__, "message", kMessage, kNothingSent}, "NULL");
        return kNotSent;
    }
    message->header._packet_type = ir_t_short;
    return send_short(__func__, emitters_of(__func__, dir), message->payload, message->header.payload_length);
}

int pogosim_send_packet(void const* descriptor, uint8_t const* data, uint32_t size, int64_t declared_length) {
    constexpr auto function = "slip_send_message";
    require_robot(function);
    require_argument(data, function, "data");
    if (descriptor != &slip_send_descriptor) {
        pogosim::refuse_user_code(
            "slip_send_message(): only the descriptor of the infrared emitters, slip_send_descriptor, is simulated");
    }
    transmit(pogosim::composed_packet(*context.world, context.device, bytes_of(data, size), declared_length));
    return 0;
}

void pogobot_infrared_set_power(uint8_t power) {
    require_robot(__func__);
    pogosim::check_emitter_power(power, NoteSlip{__func__});
    pogosim::set_ir_power(*context.world, context.device, power);
}

void pogobot_infrared_update() {
    if (context.controller == nullptr) {
        return;
    }
    context.controller->program.decodes_messages = true;
    if (context.has_robot() && context.world->mailboxes.has_commands(context.robot)) [[unlikely]] {
        if (pogosim::obey_commands(*context.world, context.robot)) {
            context.services->controllers->ask_for_restart();
        }
    }
    pogosim::note_call();
}

int pogobot_infrared_message_available() {
    require_robot(__func__);
    pogosim::note_call();
    context.controller->program.reads_messages = true;
    return context.has_robot() && !context.world->mailboxes.empty(context.robot) ? 1 : 0;
}

void pogobot_infrared_clear_message_queue() {
    require_robot(__func__);
    if (context.has_robot()) {
        context.world->mailboxes.clear(context.robot);
    }
}

void pogosim_recover_next_message(message_t* message, size_t max_payload_bytes) {
    require_robot("pogobot_infrared_recover_next_message");
    require_argument(message, "pogobot_infrared_recover_next_message", "message");
    context.controller->program.reads_messages = true;
    auto const received =
        context.has_robot() ? pogosim::receive(*context.world, context.robot) : std::optional<pogosim::Message>();
    if (!received) {
        context.services->warn_once_of({.text = pogosim::kNothingToReceive}, "{}", pogosim::kNothingToReceive);
        return;
    }
    FrameHeader const& header = received->header;
    std::memcpy(&message->header, &header, sizeof(header));
    // A program may have made its messages smaller (MAX_PAYLOAD_SIZE_BYTES).
    std::size_t const size = std::min<std::size_t>(header.payload_length, max_payload_bytes);
    if (size < header.payload_length) [[unlikely]] {
        note_slip({"pogobot_infrared_recover_next_message", "the length of the message",
                   "no more bytes than this program has room for (MAX_PAYLOAD_SIZE_BYTES)", "the message is cut"},
                  header.payload_length);
        message->header.payload_length = static_cast<std::uint16_t>(size);
    }
    std::memcpy(message->payload, received->payload.data(), size);
    std::memset(message->payload + size, 0, max_payload_bytes - size);
}

void pogobot_infrared_get_receiver_error_counter(slip_error_counter_s* const counter, uint8_t ir_index) {
    pogosim::check_receiver(ir_index, NoteSlip{__func__});
    if (counter == nullptr) [[unlikely]] {
        note_slip({__func__, "counter", "the address of the counters", "nothing is written"}, "NULL");
        return;
    }
    *counter = {};
}

void pogobot_infrared_reset_receiver_error_counter() {}

uint32_t pogobot_infrared_get_queue_drop_count() {
    require_robot(__func__);
    return context.has_robot() ? pogosim::drops_since_start(*context.world, context.robot) : 0;
}

uint32_t pogobot_infrared_get_malformed_count() {
    require_robot(__func__);
    return context.has_robot() ? pogosim::malformed_since_start(*context.world, context.robot) : 0;
}

void pogobot_infrared_ll_init() {
    require_robot(__func__);
    if (context.has_robot()) {
        pogosim::initialise_infrared(*context.world, context.robot);
    }
}

int is_muted() {
    require_robot(__func__);
    return context.devices().infrared[context.device].is_muted != 0 ? 1 : 0;
}

uint8_t* pogosim_master_mute() {
    require_robot("_master_mute");
    return &context.devices().infrared[context.device].is_muted;
}

void IR_reset_interrupt_flags() {}

bool pogosim_call_msg_tx_fn(bool (*send)()) {
    if (context.controller == nullptr) {
        return send();
    }
    std::uint64_t const before = context.devices().messages_sent[context.device];
    bool const is_sent = send();
    pogosim::SendResults& results = context.controller->send_results;
    results.sent += context.devices().messages_sent[context.device] > before ? 1U : 0U;
    results.said += is_sent ? 1U : 0U;
    pogosim::take_time_of(reinterpret_cast<void (*)()>(send));
    return is_sent;
}
