#include "sim/heard_messages.hpp"

namespace pogosim {

void HeardMessages::note(World const& world, DeliveryLog const& log) {
    double const time_s = static_cast<double>(log.step + 1) * world.time_step_s;  // when the step is over
    for (Delivery const& delivery : log.deliveries) {
        if (delivery.receiver != kNone && delivery.queued > 0) {
            time_s_[{log.air.transmissions[delivery.transmission].robot, delivery.receiver}] = time_s;
        }
    }
}

std::vector<HeardMessage> HeardMessages::until(double time_s) {
    double const first_s = time_s - static_cast<double>(kHeardForS);
    std::erase_if(time_s_, [&](auto const& heard) { return heard.second < first_s; });
    std::vector<HeardMessage> found;
    for (auto const& [pair, heard_s] : time_s_) {
        if (heard_s <= time_s) {
            found.push_back({.sender = pair.first, .receiver = pair.second, .time_s = heard_s});
        }
    }
    return found;
}

}  // namespace pogosim
