#include "comms/ir_channel.hpp"

#include <algorithm>
#include <utility>

#include "comms/assert_air.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kArrivalsAtOnce = 128;  // their mailboxes fit in the cache
// Smallest sizes of a part that one worker takes.
constexpr std::uint32_t kLeastTransmissions = 64;
constexpr std::uint32_t kLeastReceivers = 256;
constexpr std::size_t kAhead = 8;  // a mailbox is prefetched this many arrivals ahead

class LogObserver {
public:
    explicit LogObserver(std::vector<Delivery>& deliveries) : deliveries_(deliveries) {}

    void reached_none(std::uint32_t transmission) { deliveries_.push_back({.transmission = transmission}); }

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
    Delivery common_;  // what all receivers of a transmission have in common
};

/// The probability that each of `receivers` robots receives the transmission. `tables`: by category.
float probability_of(World const& world, Transmission const& transmission, std::size_t receivers,
                     std::vector<ReceptionTable>& tables) {
    std::uint32_t const category = world.robots.category[transmission.robot];
    return tables[category].probability(world.categories[category].spec.robot->ir.reception, transmission.message_bytes,
                                        transmission.send_probability, 1 + static_cast<std::uint32_t>(receivers));
}

}  // namespace

void split_by_sender(std::span<Transmission const> transmissions, std::span<std::uint32_t> ends) {
    auto const count = static_cast<std::uint32_t>(transmissions.size());
    for (std::size_t i = 0; i < ends.size(); ++i) {
        auto end = static_cast<std::uint32_t>(std::uint64_t{count} * (i + 1) / ends.size());
        while (end < count && end > 0 && transmissions[end].robot == transmissions[end - 1].robot) {
            ++end;
        }
        ends[i] = end;
    }
}

void IrChannel::deliver(World& world, DeliveryLog* log, WorkerPool* workers) {
    if (log == nullptr) {
        // A robot draws from its stream in the order of its transmissions, so one worker makes all draws of a robot.
        bool const is_shared = workers != nullptr && workers->size() > 1 &&
                               world.air.transmissions.size() >= 2 * kLeastTransmissions &&
                               std::ranges::is_sorted(world.air.transmissions, {}, &Transmission::robot);
        if (is_shared) {
            deliver_shared(world, *workers);
        } else {
            deliver_all(world);
        }
        world.air.clear();
        return;
    }
    log->step = world.step;
    log->deliveries.clear();
    deliver_logged(world, log->deliveries);
    log->air.clear();
    std::swap(world.air, log->air);
}

void IrChannel::prepare(World const& world, std::size_t workers) {
    assert_air(world);
    visibility_.update(world);
    desks_.resize(std::max(desks_.size(), workers));
    for (Desk& desk : desks_) {
        desk.reception.resize(world.categories.size());
    }
}

void IrChannel::deliver_all(World& world) {
    if (world.air.transmissions.empty()) {
        return;
    }
    prepare(world, /*workers=*/1);
    Desk& desk = desks_.front();
    auto const count = static_cast<std::uint32_t>(world.air.transmissions.size());
    for (std::uint32_t next = 0; next < count;) {
        // Sends some transmissions, while the mailboxes of their receivers are prefetched.
        arrivals_.clear();
        do {
            Transmission const& transmission = world.air.transmissions[next];
            auto const found =
                visibility_.find(world, transmission.robot, transmission.emitters, transmission.range_mm, desk.search);
            if (found.is_worth_keeping) {
                visibility_.keep(transmission.robot, transmission.emitters, transmission.range_mm, found.receivers);
            }
            attempts_ += found.receivers.size();
            receptions_ += draw_arrivals(world, next, found, desk, [&](Arrival const& arrival) {
                arrivals_.push_back(arrival);
                world.mailboxes.expect_push(arrival.receiver);
            });
            ++next;
        } while (next < count && arrivals_.size() < kArrivalsAtOnce);
        for (Arrival const& arrival : arrivals_) {
            push(world, arrival);
        }
    }
}

/// First all messages are sent, the senders divided into parts; then all arrive, the receivers divided into blocks, so
/// that each mailbox has one worker.
void IrChannel::deliver_shared(World& world, WorkerPool& workers) {
    prepare(world, workers.size());
    part_transmissions(world, workers);
    workers.run(static_cast<std::uint32_t>(parts_.size()),
                [&](std::uint32_t part, std::uint32_t worker) { find_arrivals(world, parts_[part], desks_[worker]); });
    for (Part const& part : parts_) {
        attempts_ += part.attempts;
        receptions_ += part.receptions;
        for (Kept const& kept : part.kept) {
            Transmission const& transmission = world.air.transmissions[kept.transmission];
            visibility_.keep(transmission.robot, transmission.emitters, transmission.range_mm,
                             std::span(part.kept_receivers).subspan(kept.first, kept.count));
        }
    }
    auto const blocks = static_cast<std::uint32_t>(parts_.front().arrivals.size());
    workers.run(blocks, [&](std::uint32_t block, std::uint32_t /*worker*/) {
        for (Part const& part : parts_) {
            std::vector<Arrival> const& arrivals = part.arrivals[block];
            for (std::size_t k = 0; k < arrivals.size(); ++k) {
                world.mailboxes.expect_push(arrivals[std::min(k + kAhead, arrivals.size() - 1)].receiver);
                push(world, arrivals[k]);
            }
        }
    });
}

void IrChannel::part_transmissions(World const& world, WorkerPool const& workers) {
    std::vector<Transmission> const& transmissions = world.air.transmissions;
    auto const count = static_cast<std::uint32_t>(transmissions.size());
    std::uint32_t const blocks = workers.range_count(static_cast<std::uint32_t>(world.robots.size()), kLeastReceivers);
    parts_.resize(workers.range_count(count, kLeastTransmissions));
    ends_.resize(parts_.size());
    split_by_sender(transmissions, ends_);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        Part& part = parts_[i];
        part.first = i == 0 ? 0 : ends_[i - 1];
        part.last = ends_[i];
        part.arrivals.resize(blocks);
    }
}

void IrChannel::find_arrivals(World& world, Part& part, Desk& desk) const {
    part.attempts = part.receptions = 0;
    part.kept.clear();
    part.kept_receivers.clear();
    for (std::vector<Arrival>& arrivals : part.arrivals) {
        arrivals.clear();
    }
    for (std::uint32_t i = part.first; i < part.last; ++i) {
        find_arrivals_of(world, i, part, desk);
    }
}

/// Appends the arrivals of the transmission to the part.
void IrChannel::find_arrivals_of(World& world, std::uint32_t index, Part& part, Desk& desk) const {
    Transmission const& transmission = world.air.transmissions[index];
    auto const found =
        visibility_.find(world, transmission.robot, transmission.emitters, transmission.range_mm, desk.search);
    auto const receivers = found.receivers;
    if (found.is_worth_keeping) {
        part.kept.push_back({.transmission = index,
                             .first = static_cast<std::uint32_t>(part.kept_receivers.size()),
                             .count = static_cast<std::uint32_t>(receivers.size())});
        part.kept_receivers.insert(part.kept_receivers.end(), receivers.begin(), receivers.end());
    }
    part.attempts += receivers.size();
    std::uint64_t const blocks = part.arrivals.size();
    part.receptions += draw_arrivals(world, index, found, desk, [&](Arrival const& arrival) {
        part.arrivals[arrival.receiver * blocks / world.robots.size()].push_back(arrival);
    });
}

/// Draws for each receiver whether it gets the transmission. Calls arrive(arrival) for those that do, in their order,
/// and returns how many do.
template <class Arrive>
std::size_t IrChannel::draw_arrivals(World& world, std::uint32_t index, Visibility::Found const& found, Desk& desk,
                                     Arrive const& arrive) const {
    auto const receivers = found.receivers;
    if (receivers.empty()) {
        return 0;
    }
    Transmission const& transmission = world.air.transmissions[index];
    float const probability = probability_of(world, transmission, receivers.size(), desk.reception);
    if (desk.hits.size() < receivers.size()) {
        desk.hits.resize(receivers.size());
    }
    auto const hits = std::span(desk.hits).first(receivers.size());
    std::size_t const count = world.robots.stream[transmission.robot].hits_of(probability, hits);
    if (!found.hearers.empty()) {
        for (std::uint32_t const hit : hits.first(count)) {
            Hearer const hearer = found.hearers[hit];
            arrive({.receiver = hearer.robot, .transmission = index, .faces = static_cast<std::uint8_t>(hearer.faces)});
        }
        return count;
    }
    for (std::uint32_t const hit : hits.first(count)) {
        Receiver const& receiver = receivers[hit];
        arrive({.receiver = receiver.robot,
                .transmission = index,
                .faces = visibility_.faces_of(world, receiver, transmission.range_mm)});
    }
    return count;
}

void IrChannel::push(World& world, Arrival const& arrival) {
    Transmission const& transmission = world.air.transmissions[arrival.transmission];
    world.mailboxes.deliver(arrival.receiver, transmission.header, world.air.payload_of(transmission),
                            transmission.kind, arrival.faces);
}

/// As deliver_all(), one receiver after the other.
void IrChannel::deliver_logged(World& world, std::vector<Delivery>& deliveries) {
    if (world.air.transmissions.empty()) {
        return;
    }
    prepare(world, /*workers=*/1);
    LogObserver observer(deliveries);
    for (std::uint32_t i = 0; i < world.air.transmissions.size(); ++i) {
        Transmission const& transmission = world.air.transmissions[i];
        auto const receivers =
            visibility_.receivers(world, transmission.robot, transmission.emitters, transmission.range_mm);
        if (receivers.empty()) {
            observer.reached_none(i);
            continue;
        }
        float const probability = probability_of(world, transmission, receivers.size(), desks_.front().reception);
        observer.reached(i, receivers.size(), probability);
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
            unsigned const queued =
                world.mailboxes.deliver(receiver.robot, transmission.header, payload, transmission.kind, faces);
            observer.received(world, receiver, faces, static_cast<std::uint8_t>(queued));
        }
    }
}

}  // namespace pogosim
