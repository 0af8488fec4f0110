// The infrared channel: delivers the transmissions of a step to the mailboxes of their receivers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/worker_pool.hpp"
#include "comms/delivery_log.hpp"
#include "comms/reception.hpp"
#include "comms/visibility.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Splits transmissions that are sorted by sender into as many parts as `ends` has places, of about the same size, some
/// of them empty. Part i ends before transmission ends[i]. All transmissions of a robot are in the same part, since
/// they draw from the robot's stream in their order.
void split_by_sender(std::span<Transmission const> transmissions, std::span<std::uint32_t> ends);

class IrChannel {
public:
    /// Delivers all transmissions of world.air, in the order in which they were made, and clears it. Each robot in
    /// range gets the message with the sender's reception probability, drawn from the sender's stream: one copy for
    /// each of its faces that sees the emitter. `log`, if not null, is replaced by the outcome of each transmission.
    /// `workers`, if there are several and no log, share the work of many transmissions; the outcome does not depend on
    /// them.
    void deliver(World& world, DeliveryLog* log = nullptr, WorkerPool* workers = nullptr);

    /// Number of (message, robot in range) pairs since the start, and how many of them were received.
    std::uint64_t attempts() const { return attempts_; }
    std::uint64_t receptions() const { return receptions_; }

private:
    /// A message that a robot receives.
    struct Arrival {
        std::uint32_t receiver;
        std::uint32_t transmission;
        std::uint8_t faces;
    };

    /// Receivers for the visibility to cache.
    struct Kept {
        std::uint32_t transmission;
        std::uint32_t first;  // in Part::kept_receivers
        std::uint32_t count;
    };

    /// A range of consecutive transmissions that one worker sends.
    struct Part {
        std::uint32_t first = 0;
        std::uint32_t last = 0;
        std::vector<std::vector<Arrival>> arrivals;  // by block of receivers
        std::vector<Kept> kept;
        std::vector<Receiver> kept_receivers;
        std::uint64_t attempts = 0;
        std::uint64_t receptions = 0;
    };

    /// Scratch memory of a worker.
    struct Desk {
        Visibility::Search search;
        std::vector<ReceptionTable> reception;  // by category
        std::vector<std::uint32_t> hits;        // receivers whose draws succeed
    };

    void prepare(World const& world, std::size_t workers);
    void deliver_all(World& world);
    void deliver_logged(World& world, std::vector<Delivery>& deliveries);
    void deliver_shared(World& world, WorkerPool& workers);
    void part_transmissions(World const& world, WorkerPool const& workers);
    void find_arrivals(World& world, Part& part, Desk& desk) const;
    void find_arrivals_of(World& world, std::uint32_t transmission, Part& part, Desk& desk) const;
    template <class Arrive>
    std::size_t draw_arrivals(World& world, std::uint32_t transmission, Visibility::Found const& found, Desk& desk,
                              Arrive const& arrive) const;
    static void push(World& world, Arrival const& arrival);

    std::vector<Part> parts_;
    std::vector<std::uint32_t> ends_;  // of the parts, see split_by_sender()
    std::vector<Desk> desks_;
    std::vector<Arrival> arrivals_;  // of some transmissions

    Visibility visibility_;
    std::uint64_t attempts_ = 0;
    std::uint64_t receptions_ = 0;
};

}  // namespace pogosim
