#include "sim/message_recorder.hpp"

#include <cmath>
#include <utility>

#include "interface/pogobase_inside.hpp"

namespace pogosim {

namespace {

LoggedRobot named(World const& world, std::uint32_t robot) {
    return {.index = static_cast<std::int32_t>(robot),
            .id = static_cast<std::int32_t>(world.robots.id[robot]),
            .category = world.categories[world.robots.category[robot]].name};
}

MessageType type_of(FrameHeader const& header) {
    switch (header.packet_type) {
        case ir_t_user:
            return MessageType::long_message;
        case ir_t_short:
            return MessageType::short_message;
        case ir_t_cmd:
            return MessageType::command;
        default:
            return MessageType::other;
    }
}

LoggedReception reception_of(World const& world, Delivery const& delivery, PacketKind kind) {
    LoggedReception reception{.receiver = named(world, delivery.receiver),
                              .emitters = delivery.emitters,
                              .faces = delivery.faces,
                              .cluster_size = static_cast<std::int32_t>(delivery.cluster_size),
                              .probability = delivery.probability,
                              .copies = static_cast<std::int8_t>(delivery.queued)};
    if (!std::isnan(delivery.distance_mm)) {
        reception.distance_mm = delivery.distance_mm;
    }
    if (!delivery.is_received) {
        reception.outcome = MessageOutcome::lost;
    } else if (kind == PacketKind::malformed) {
        reception.outcome = MessageOutcome::malformed;
    } else if (delivery.queued == 0) {
        reception.outcome = MessageOutcome::queue_full;
    }
    return reception;
}

}  // namespace

MessageRecorder::MessageRecorder(std::string const& path, World const& world)
    : world_(world), reserved_(MessageLog::reserve(path)) {}

void MessageRecorder::open(MessageLogOptions const& options) {
    log_ = std::make_unique<MessageLog>(options, std::move(reserved_));
}

void MessageRecorder::record() {
    TransmissionQueue const& air = deliveries_.air;
    for (Delivery const& delivery : deliveries_.deliveries) {
        Transmission const& transmission = air.transmissions[delivery.transmission];
        MessageRow row{.time_s = static_cast<double>(deliveries_.step) * world_.time_step_s,
                       .step = deliveries_.step,
                       .message = messages_ + delivery.transmission,
                       .sender = named(world_, transmission.robot),
                       .faces = transmission.emitters,
                       .type = type_of(transmission.header),
                       .payload = air.payload_of(transmission),
                       .message_bytes = transmission.message_bytes,
                       .send_probability = transmission.send_probability};
        if (delivery.receiver != kNone) {
            row.reception = reception_of(world_, delivery, transmission.kind);
        }
        log_->append(row);
    }
    messages_ += std::ssize(air.transmissions);
    deliveries_.air.clear();
    deliveries_.deliveries.clear();
}

void MessageRecorder::save_if_due() {
    log_->save_if_due();
}

void MessageRecorder::save() {
    log_->save();
}

void MessageRecorder::add_metadata(std::string const& key, std::string const& value) {
    log_->add_metadata(key, value);
}

void MessageRecorder::close() {
    log_->close();
    is_complete_ = true;
}

}  // namespace pogosim
