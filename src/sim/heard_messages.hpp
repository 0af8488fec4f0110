// Which robots heard which lately, for pictures.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "comms/delivery_log.hpp"
#include "render/snapshot.hpp"
#include "world/world.hpp"

namespace pogosim {

class HeardMessages {
public:
    /// Takes what was delivered in a step: messages that found room in the queue of a receiver.
    void note(World const& world, DeliveryLog const& log);

    void clear() { time_s_.clear(); }

    /// Those of the last kHeardForS before a time, each pair of sender and receiver once, by their indices.
    std::vector<HeardMessage> until(double time_s);

private:
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> time_s_;  // of the last message, by sender and receiver
};

}  // namespace pogosim
