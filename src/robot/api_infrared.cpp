// pogolib/infrared.h: messages sent by user code are put on the air; comms delivers them after every robot has run.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#include "base/log.hpp"
#include "pogosim/program.h"
#include "process/crash_handler.hpp"
#include "robot/context.hpp"
#include "robot/controllers.hpp"
#include "robot/require_robot.hpp"
#include "robot/robot_floating_point.hpp"
#include "robot/slip.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::FrameHeader;
using pogosim::kAllFaces;
using pogosim::kFaceCount;
using pogosim::kind_of_packet;
using pogosim::note_slip;
using pogosim::PacketKind;
using pogosim::require_argument;
using pogosim::require_robot;

namespace {

// The article's library adds these to a message's size: 3 bytes in front of a short payload, 8 in front of a long one.
constexpr std::uint16_t kShortHeaderBytes = 3;
constexpr std::uint16_t kLongHeaderBytes = 8;

// What a receiver sees of a short message.
constexpr std::uint16_t kNoSender = 0xFF;
constexpr std::uint8_t kNoSenderIndex = 0xF;

constexpr std::uint32_t kSent = 0;
constexpr std::uint32_t kNotSent = 1;
constexpr auto kNothingSent = "nothing is sent, and the function returns 1";
constexpr auto kMessage = "the address of a message";

static_assert(sizeof(FrameHeader) == sizeof(message_header_t));

/// Chance that a robot sends in the time of a tick, for the article's law of reception. In an endless loop in main(),
/// it is what the robot has done in the last second or two.
float send_probability() {
    constexpr float largest_percentage = 100.0F;
    if (context.phase != pogosim::Phase::main) {
        return std::min<float>(percent_msgs_sent_per_ticks, largest_percentage) / largest_percentage;
    }
    constexpr std::int64_t window_us = 1000000;
    constexpr std::int64_t tick_us = 16000;  // of the main loop at 60 Hz
    std::int64_t const now_us = context.controller->clock_us;
    pogosim::SentRate& rate = context.controller->sent_rate;
    if (now_us - rate.began_us >= window_us) {
        rate = {.before_us = rate.began_us, .began_us = now_us, .before = rate.present};
    }
    rate.present += now_us != std::exchange(rate.last_us, now_us) ? 1 : 0;
    std::int64_t const watched_us = now_us - rate.before_us + tick_us;
    return std::min(1.0F, static_cast<float>(rate.before + rate.present) * static_cast<float>(tick_us) /
                              static_cast<float>(watched_us));
}

/// Puts one transmission on the air. Robots that receive it pass a packet on unless it is malformed.
void transmit(std::uint8_t emitters, std::uint8_t power, PacketKind kind, FrameHeader const& header,
              std::uint16_t header_bytes, std::uint8_t const* payload) {
    pogosim::note_call();
    if (!context.has_robot() || emitters == 0 || power == 0) {
        return;
    }
    pogosim::take_back_floating_point();
    ++context.controller->messages_sent;
    pogosim::TransmissionQueue& air = pogosim::current_air();
    air.transmissions.push_back({.robot = context.robot,
                                 .emitters = emitters,
                                 .kind = kind,
                                 .message_bytes = static_cast<std::uint16_t>(header_bytes + header.payload_length),
                                 .send_probability = send_probability(),
                                 .range_mm = context.spec().ir.range_at_mm(power),
                                 .header = header,
                                 .payload_offset = air.payloads.size()});
    auto const bytes = std::as_bytes(std::span(payload, header.payload_length));
    air.payloads.insert(air.payloads.end(), bytes.begin(), bytes.end());
}

/// Sends a message, unless something is wrong with it or the robot is muted.
std::uint32_t send(char const* function, std::uint8_t emitters, std::uint8_t power, FrameHeader const& header,
                   std::uint16_t header_bytes, std::uint8_t const* payload) {
    if (header.payload_length > MAX_PAYLOAD_SIZE_BYTES) [[unlikely]] {
        static_assert(MAX_PAYLOAD_SIZE_BYTES == 382);
        note_slip({function, "the length of the message", "0 to 382 bytes (MAX_PAYLOAD_SIZE_BYTES)", kNothingSent},
                  header.payload_length);
        return kNotSent;
    }
    if (payload == nullptr && header.payload_length > 0) [[unlikely]] {
        note_slip({function, "message", kMessage, kNothingSent}, "NULL");
        return kNotSent;
    }
    pogosim::InfraredState& infrared = context.controller->infrared;
    if (infrared.is_muted != 0) [[unlikely]] {
        ++infrared.muted_messages;
        pogosim::note_call();
        return kNotSent;
    }
    PacketKind const kind = kind_of_packet(header, std::as_bytes(std::span(payload, header.payload_length)));
    transmit(emitters, power, kind, header, header_bytes, payload);
    return kSent;
}

std::uint8_t emitters_of(char const* function, ir_direction direction) {
    int const index = static_cast<int>(direction);
    if (index < 0 || index > static_cast<int>(ir_all)) [[unlikely]] {
        note_slip({function, "dir", "ir_front (0) to ir_left (3), or ir_all (4)", "the message goes in all directions"},
                  index);
    }
    return index >= 0 && index < kFaceCount ? static_cast<std::uint8_t>(1U << index) : kAllFaces;
}

/// Power list that drives these emitters with the robot's power.
std::uint8_t power_list(std::uint8_t emitters) {
    unsigned list = 0;
    for (unsigned face = 0; face < kFaceCount; ++face) {
        if ((emitters >> face & 1U) != 0) {
            list |= static_cast<unsigned>(context.controller->ir_power) << (face * pogobot_infrared_emitter_width_bits);
        }
    }
    return static_cast<std::uint8_t>(list);
}

/// The largest power of a list; emitters of different power are not told apart.
std::uint8_t highest_power(std::uint8_t list) {
    std::uint8_t highest = 0;
    for (unsigned face = 0; face < kFaceCount; ++face) {
        highest = std::max<std::uint8_t>(highest, get_infrared_emitter_dir(face, list));
    }
    return highest;
}

/// The emitter index that receivers see: 4 for all of them, otherwise the first one.
std::uint8_t sender_index(std::uint8_t emitters) {
    return emitters == kAllFaces ? static_cast<std::uint8_t>(ir_all)
                                 : static_cast<std::uint8_t>(__builtin_ctz(emitters | 1U << kFaceCount));
}

std::uint32_t send_long(char const* function, std::uint8_t emitters, std::uint8_t list, std::uint8_t const* payload,
                        std::uint16_t size, std::uint8_t type = ir_t_user) {
    FrameHeader const header{.packet_type = type,
                             .emitting_power_list = list,
                             .sender_id = pogobot_helper_getid(),
                             .sender_ir_index = sender_index(emitters),
                             .receiver_ir_index = 0,
                             .payload_length = size};
    return send(function, emitters, highest_power(list), header, kLongHeaderBytes, payload);
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

/// Emitters with a power that is not 0.
std::uint8_t emitters_in(std::uint8_t list) {
    std::uint8_t emitters = 0;
    for (unsigned face = 0; face < kFaceCount; ++face) {
        if (get_infrared_emitter_dir(face, list) != 0) {
            emitters = static_cast<std::uint8_t>(emitters | 1U << face);
        }
    }
    return emitters;
}

std::uint32_t send_short(char const* function, std::uint8_t emitters, std::uint8_t const* payload, std::uint16_t size) {
    // A short header carries neither sender nor emitter.
    FrameHeader const header{.packet_type = ir_t_short,
                             .emitting_power_list = 0,
                             .sender_id = kNoSender,
                             .sender_ir_index = kNoSenderIndex,
                             .receiver_ir_index = 0,
                             .payload_length = size};
    return send(function, emitters, context.controller->ir_power, header, kShortHeaderBytes, payload);
}

}  // namespace

struct pogosim_slip_descriptor const slip_send_descriptor = {};

uint32_t pogobot_infrared_sendLongMessage_omniGen(uint8_t* const message, uint16_t const message_size) {
    require_robot(__func__);
    return send_long(__func__, kAllFaces, power_list(kAllFaces), message, message_size);
}

uint32_t pogobot_infrared_sendLongMessage_omniSpe(uint8_t* const message, uint16_t const message_size) {
    require_robot(__func__);
    uint32_t errors = 0;
    for (unsigned face = 0; face < kFaceCount; ++face) {
        auto const emitter = static_cast<std::uint8_t>(1U << face);
        errors += send_long(__func__, emitter, power_list(emitter), message, message_size);
    }
    return errors;
}

uint32_t pogobot_infrared_sendLongMessage_uniSpe(ir_direction dir, uint8_t* const message,
                                                 uint16_t const message_size) {
    require_robot(__func__);
    std::uint8_t const emitters = emitters_of(__func__, dir);
    return send_long(__func__, emitters, power_list(emitters), message, message_size);
}

uint32_t pogobot_infrared_sendShortMessage_omni(uint8_t* const message, uint16_t const message_size) {
    require_robot(__func__);
    return send_short(__func__, kAllFaces, message, message_size);
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
    std::uint8_t const emitters = emitters_in(list);
    if (emitters == 0) [[unlikely]] {
        note_slip({__func__, "_emitting_power_list", "a power that is not 0 for at least one emitter",
                   "nothing is sent, as on a real robot"},
                  list);
    }
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
    bool const is_short = size > 0 && data[0] == ir_t_short;
    std::size_t const header_bytes = is_short ? sizeof(message_short_header_t) : sizeof(message_header_t);
    FrameHeader header{.packet_type = ir_t_short, .sender_id = kNoSender, .sender_ir_index = kNoSenderIndex};
    if (size >= header_bytes && is_short) {
        message_short_header_t given;
        std::memcpy(&given, data, header_bytes);
        header.payload_length = given.payload_length;
    } else if (size >= header_bytes) {
        std::memcpy(&header, data, header_bytes);
    }
    std::uint8_t const list =
        is_short || header.emitting_power_list == 0 ? power_list(kAllFaces) : header.emitting_power_list;
    std::size_t const payload_bytes = size - std::min<std::size_t>(size, header_bytes);
    bool const is_whole = size >= header_bytes && header.payload_length == payload_bytes &&
                          (declared_length < 0 || declared_length == header.payload_length) &&
                          payload_bytes <= MAX_PAYLOAD_SIZE_BYTES;
    std::uint8_t const* const payload = data + (size - payload_bytes);
    header.payload_length = static_cast<std::uint16_t>(std::min<std::size_t>(payload_bytes, MAX_PAYLOAD_SIZE_BYTES));
    PacketKind const kind = is_whole ? kind_of_packet(header, std::as_bytes(std::span(payload, header.payload_length)))
                                     : PacketKind::malformed;
    transmit(emitters_in(list), highest_power(list), kind, header, is_short ? kShortHeaderBytes : kLongHeaderBytes,
             payload);
    return 0;
}

void pogobot_infrared_set_power(uint8_t power) {
    require_robot(__func__);
    if (power > pogobot_infrared_emitter_power_max) [[unlikely]] {
        note_slip({__func__, "power", "0 to 3", "3 is used"}, power);
    }
    context.controller->ir_power = std::min<uint8_t>(power, pogobot_infrared_emitter_power_max);
}

void pogobot_infrared_update() {
    if (context.controller == nullptr) {
        return;
    }
    context.controller->program.decodes_messages = true;
    if (context.has_robot() && context.world->mailboxes.has_commands(context.robot)) [[unlikely]] {
        if (obey_commands(context.world->mailboxes, context.robot, context.controller->infrared)) {
            context.services->access.controllers->ask_for_restart();
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
    FrameHeader header;
    std::span const payload = std::as_writable_bytes(std::span(message->payload, max_payload_bytes));
    if (!context.has_robot() || !context.world->mailboxes.pop(context.robot, header, payload)) {
        context.services->warn_once(
            "pogobot_infrared_recover_next_message was called with no message waiting: check "
            "pogobot_infrared_message_available() first");
        return;
    }
    ++context.controller->messages_received;
    // A program may have made its messages smaller (MAX_PAYLOAD_SIZE_BYTES).
    std::size_t const size = std::min<std::size_t>(header.payload_length, max_payload_bytes);
    if (size < header.payload_length) [[unlikely]] {
        note_slip({"pogobot_infrared_recover_next_message", "the length of the message",
                   "no more bytes than this program has room for (MAX_PAYLOAD_SIZE_BYTES)", "the message is cut"},
                  header.payload_length);
    }
    header.payload_length = static_cast<std::uint16_t>(size);
    std::memcpy(&message->header, &header, sizeof(header));
    std::ranges::fill(payload.subspan(size), std::byte{0});
}

void pogobot_infrared_get_receiver_error_counter(slip_error_counter_s* const counter, uint8_t ir_index) {
    if (ir_index >= IR_RX_COUNT) [[unlikely]] {
        note_slip({__func__, "ir_index", "0 (front) to 3 (left)", "the counters are set to 0"}, ir_index);
    }
    if (counter == nullptr) [[unlikely]] {
        note_slip({__func__, "counter", "the address of the counters", "nothing is written"}, "NULL");
        return;
    }
    *counter = {};
}

void pogobot_infrared_reset_receiver_error_counter() {}

uint32_t pogobot_infrared_get_queue_drop_count() {
    require_robot(__func__);
    return context.has_robot()
               ? drops_since_start(context.world->mailboxes, context.robot, context.controller->infrared)
               : 0;
}

uint32_t pogobot_infrared_get_malformed_count() {
    require_robot(__func__);
    return context.has_robot()
               ? malformed_since_start(context.world->mailboxes, context.robot, context.controller->infrared)
               : 0;
}

void pogobot_infrared_ll_init() {
    require_robot(__func__);
    if (context.has_robot()) {
        initialise_infrared(context.world->mailboxes, context.robot, context.controller->infrared);
    }
}

int is_muted() {
    require_robot(__func__);
    return context.controller->infrared.is_muted != 0 ? 1 : 0;
}

uint8_t* pogosim_master_mute() {
    require_robot("_master_mute");
    return &context.controller->infrared.is_muted;
}

void IR_reset_interrupt_flags() {}

bool pogosim_call_msg_tx_fn(bool (*send)()) {
    if (context.controller == nullptr) {
        return send();
    }
    std::uint64_t const before = context.controller->messages_sent;
    bool const is_sent = send();
    pogosim::Controller& self = *context.controller;
    self.send_results.sent += self.messages_sent > before ? 1U : 0U;
    self.send_results.said += is_sent ? 1U : 0U;
    return is_sent;
}
