#include "comms/ir_channel.hpp"

#include <algorithm>
#include <utility>

#include "comms/assert_air.hpp"
#include "comms/reception.hpp"

namespace pogosim {

namespace {

std::uint8_t faces_of(World const& world, Transmission const& transmission, Receiver const& receiver) {
    return receiver.faces != 0
               ? receiver.faces
               : faces_that_see(world, receiver.robot, -receiver.from_emitter_mm, transmission.range_mm);
}

/// Nobody wants to know: costs nothing.
struct NoObserver {
    void reached_nobody(std::uint32_t /*transmission*/) const {}
    void reached(std::uint32_t /*transmission*/, std::size_t /*receivers*/, float /*probability*/) const {}
    void lost(World const& /*world*/, Transmission const& /*transmission*/, Receiver const& /*receiver*/) const {}
    void received(World const& /*world*/, Receiver const& /*receiver*/, std::uint8_t /*faces*/,
                  std::uint8_t /*queued*/) const {}
};

class LogObserver {
public:
    explicit LogObserver(std::vector<Delivery>& deliveries) : deliveries_(deliveries) {}

    void reached_nobody(std::uint32_t transmission) { deliveries_.push_back({.transmission = transmission}); }

    void reached(std::uint32_t transmission, std::size_t receivers, float probability) {
        common_ = {.transmission = transmission,
                   .cluster_size = static_cast<std::uint32_t>(receivers + 1),
                   .probability = probability};
    }

    void lost(World const& world, Transmission const& transmission, Receiver const& receiver) {
        add(world, receiver).faces = faces_of(world, transmission, receiver);
    }

    void received(World const& world, Receiver const& receiver, std::uint8_t faces, std::uint8_t queued) {
        Delivery& delivery = add(world, receiver);
        delivery.faces = faces;
        delivery.is_received = true;
        delivery.queued = queued;
    }

private:
    Delivery& add(World const& world, Receiver const& receiver) {
        Delivery& delivery = deliveries_.emplace_back(common_);
        delivery.receiver = receiver.robot;
        delivery.emitters = receiver.emitters;
        bool const is_along_outline = receiver.faces != 0;
        if (!is_along_outline) {
            float const radius_mm = world.bodies.radius_mm[world.robots.body[receiver.robot]];
            delivery.distance_mm = std::max(length(receiver.from_emitter_mm) - radius_mm, 0.0F);
        }
        return delivery;
    }

    std::vector<Delivery>& deliveries_;
    Delivery common_;  // to all receivers of a transmission
};

}  // namespace

void IrChannel::deliver(World& world, DeliveryLog* log) {
    if (log == nullptr) {
        NoObserver nobody;
        deliver_all(world, nobody);
        world.air.clear();
        return;
    }
    log->step = world.step;
    log->deliveries.clear();
    LogObserver observer(log->deliveries);
    deliver_all(world, observer);
    log->air.clear();
    std::swap(world.air, log->air);
}

template <class Observer>
void IrChannel::deliver_all(World& world, Observer& observer) {
    if (world.air.transmissions.empty()) {
        return;
    }
    assert_air(world);
    visibility_.update(world);
    for (std::uint32_t i = 0; i < world.air.transmissions.size(); ++i) {
        deliver_one(world, i, observer);
    }
}

template <class Observer>
void IrChannel::deliver_one(World& world, std::uint32_t index, Observer& observer) {
    Transmission const& transmission = world.air.transmissions[index];
    IrSpec const& ir = world.spec_of(transmission.robot).ir;
    auto const receivers =
        visibility_.receivers(world, transmission.robot, transmission.emitters, transmission.range_mm);
    if (receivers.empty()) {
        observer.reached_nobody(index);
        return;
    }
    auto const probability = static_cast<float>(reception_probability(ir.reception, transmission.message_bytes,
                                                                      transmission.send_probability,
                                                                      1.0 + static_cast<double>(receivers.size())));
    observer.reached(index, receivers.size(), probability);
    RandomStream& stream = world.robots.stream[transmission.robot];
    attempts_ += receivers.size();
    for (Receiver const& receiver : receivers) {
        if (stream.uniform() >= probability) {
            observer.lost(world, transmission, receiver);
            continue;
        }
        ++receptions_;
        std::uint8_t const faces = faces_of(world, transmission, receiver);
        std::uint8_t queued = 0;
        FrameHeader header = transmission.header;
        for (unsigned face = 0; face < kFaceCount; ++face) {
            if ((faces >> face & 1U) != 0) {
                header.receiver_ir_index = static_cast<std::uint8_t>(face);
                bool const has_room = world.mailboxes.push(receiver.robot, header, world.air.payload_of(transmission));
                queued = static_cast<std::uint8_t>(queued + (has_room ? 1 : 0));
            }
        }
        observer.received(world, receiver, faces, queued);
    }
}

}  // namespace pogosim
