// The air between the robots: takes what was sent in a step to the mailboxes of those who receive it.
#pragma once

#include <cstdint>

#include "comms/visibility.hpp"
#include "world/world.hpp"

namespace pogosim {

class IrChannel {
public:
    /// Delivers every transmission on the air, in the order in which they were made, and clears the air. Each robot in
    /// reach gets the message with the sender's reception probability, drawn from the sender's stream: one copy for
    /// each of its faces that sees the emitter.
    void deliver(World& world);

    /// (Message, receiver) pairs in reach, and those of them that were received, since the start.
    std::uint64_t attempts() const { return attempts_; }
    std::uint64_t receptions() const { return receptions_; }

private:
    void deliver(World& world, Transmission const& transmission);

    Visibility visibility_;
    std::uint64_t attempts_ = 0;
    std::uint64_t receptions_ = 0;
};

}  // namespace pogosim
