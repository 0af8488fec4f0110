// The air between the robots: takes what was sent in a step to the mailboxes of those who receive it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "comms/delivery_log.hpp"
#include "comms/reception_table.hpp"
#include "comms/visibility.hpp"
#include "world/world.hpp"

namespace pogosim {

class IrChannel {
public:
    /// Delivers every transmission on the air, in the order in which they were made, and clears the air. Each robot in
    /// reach gets the message with the sender's reception probability, drawn from the sender's stream: one copy for
    /// each of its faces that sees the emitter. `log`, if there is one, gets what became of each, in place of what it
    /// had.
    void deliver(World& world, DeliveryLog* log = nullptr);

    /// (Message, receiver) pairs in reach, and those of them that were received, since the start.
    std::uint64_t attempts() const { return attempts_; }
    std::uint64_t receptions() const { return receptions_; }

private:
    template <class Observer>
    void deliver_all(World& world, Observer& observer);
    template <class Observer>
    void deliver_one(World& world, std::uint32_t transmission, std::span<Receiver const> receivers, Observer& observer);

    Visibility visibility_;
    std::vector<ReceptionTable> reception_;  // by category
    std::vector<Receiver> found_;            // of some transmissions, one after the other
    std::vector<std::size_t> reached_;       // ends of their receivers in found_
    std::uint64_t attempts_ = 0;
    std::uint64_t receptions_ = 0;
};

}  // namespace pogosim
