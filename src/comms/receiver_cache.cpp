#include "comms/receiver_cache.hpp"

#include <algorithm>

namespace pogosim {

namespace {

// If all robots hear each other, the lists grow with the square of their number: beyond this size, receivers are not
// cached.
constexpr std::size_t kMostPerRobot = 16;
constexpr std::size_t kMostBesides = std::size_t{1} << 20U;

}  // namespace

void ReceiverCache::clear(std::size_t robot_count) {
    robot_count_ = robot_count;
    for (std::vector<List>& lists : lists_) {
        lists.clear();
    }
    pool_.clear();
    hearers_.clear();
    in_use_ = 0;
}

bool ReceiverCache::make_room(List& list, std::size_t count) {
    if (count <= list.room) {
        return true;
    }
    std::size_t const most = kMostPerRobot * robot_count_ + kMostBesides;
    if (pool_.size() + count > most) {
        if (in_use_ > most / 2) {
            return false;
        }
        // Most of the pool is abandoned: start anew.
        for (std::vector<List>& lists : lists_) {
            std::ranges::fill(lists, List{});
        }
        pool_.clear();
        hearers_.clear();
        in_use_ = 0;
    }
    in_use_ += count - list.room;
    list.first = static_cast<std::uint32_t>(pool_.size());
    list.room = static_cast<std::uint32_t>(count);
    pool_.resize(pool_.size() + count);
    hearers_.resize(pool_.size());
    return true;
}

void ReceiverCache::store(std::uint32_t robot, std::uint8_t emitters, float range_mm, std::uint32_t changes,
                          std::span<Receiver const> receivers) {
    std::vector<List>& lists = lists_[kind_of(emitters)];
    if (lists.empty()) {
        lists.resize(robot_count_);
    }
    List& list = lists[robot];
    if (!make_room(list, receivers.size())) {
        list.range_mm = 0.0F;
        return;
    }
    list.changes = changes;
    list.range_mm = range_mm;
    list.emitters = emitters;
    list.count = static_cast<std::uint32_t>(receivers.size());
    std::ranges::copy(receivers, pool_.begin() + list.first);
    std::ranges::transform(receivers, hearers_.begin() + list.first, [](Receiver const& receiver) {
        return Hearer{.robot = receiver.robot, .faces = receiver.faces};
    });
}

}  // namespace pogosim
