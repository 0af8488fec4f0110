#include "comms/ir_channel.hpp"

#include <algorithm>
#include <utility>

#include "comms/assert_air.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kReceiversAtOnce = 128;  // their mailboxes fill a part of the cache

/// Nobody wants to know: costs nothing.
struct NoObserver {
    void reached_nobody(std::uint32_t /*transmission*/) const {}
    void reached(std::uint32_t /*transmission*/, std::size_t /*receivers*/, float /*probability*/) const {}
    void lost(World const& /*world*/, Visibility const& /*visibility*/, Transmission const& /*transmission*/,
              Receiver const& /*receiver*/) const {}
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

    void lost(World const& world, Visibility const& visibility, Transmission const& transmission,
              Receiver const& receiver) {
        add(world, receiver).faces = visibility.faces_of(world, receiver, transmission.range_mm);
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
        if (!receiver.is_along_outline) {
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
    reception_.resize(world.categories.size());
    std::size_t const count = world.air.transmissions.size();
    for (std::size_t next = 0; next < count;) {
        // Who is in reach of some transmissions; their mailboxes come into the cache in the meantime.
        std::size_t const begin = next;
        found_.clear();
        reached_.clear();
        do {
            Transmission const& transmission = world.air.transmissions[next++];
            std::size_t const first = found_.size();
            visibility_.find_receivers(world, transmission.robot, transmission.emitters, transmission.range_mm, found_);
            reached_.push_back(found_.size());
            for (std::size_t k = first; k < found_.size(); ++k) {
                world.mailboxes.expect_push(found_[k].robot);
            }
        } while (next < count && found_.size() < kReceiversAtOnce);
        std::size_t first = 0;
        for (std::size_t i = begin; i < next; ++i) {
            std::size_t const end = reached_[i - begin];
            deliver_one(world, static_cast<std::uint32_t>(i), std::span(found_).subspan(first, end - first), observer);
            first = end;
        }
    }
}

template <class Observer>
void IrChannel::deliver_one(World& world, std::uint32_t index, std::span<Receiver const> receivers,
                            Observer& observer) {
    Transmission const& transmission = world.air.transmissions[index];
    if (receivers.empty()) {
        observer.reached_nobody(index);
        return;
    }
    std::uint32_t const category = world.robots.category[transmission.robot];
    float const probability = reception_[category].probability(
        world.categories[category].spec.robot->ir.reception, transmission.message_bytes, transmission.send_probability,
        1 + static_cast<std::uint32_t>(receivers.size()));
    observer.reached(index, receivers.size(), probability);
    std::span<std::byte const> const payload = world.air.payload_of(transmission);
    RandomStream& stream = world.robots.stream[transmission.robot];
    attempts_ += receivers.size();
    for (Receiver const& receiver : receivers) {
        if (stream.uniform() >= probability) {
            observer.lost(world, visibility_, transmission, receiver);
            continue;
        }
        ++receptions_;
        std::uint8_t const faces = visibility_.faces_of(world, receiver, transmission.range_mm);
        unsigned const queued = world.mailboxes.push_copies(receiver.robot, transmission.header, payload, faces);
        observer.received(world, receiver, faces, static_cast<std::uint8_t>(queued));
    }
}

}  // namespace pogosim
