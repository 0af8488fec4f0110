// Cache of the receivers of each robot's last transmissions, valid while nothing within its range changes.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec2.hpp"
#include "world/mailbox.hpp"
#include "world/robot_model.hpp"

namespace pogosim {

/// One robot that a transmission reaches.
struct Receiver {
    std::uint32_t robot = 0;
    Vec2 from_emitter_mm{};  // from the nearest emitter that sees the receiver to its centre
    // Bit d: its face d receives. 0: not computed yet, see Visibility::faces_of(); needed only if the message arrives.
    std::uint8_t faces = 0;
    std::uint8_t emitters = 0;      // bit d: emitter d, one of those of the query, reaches it
    bool is_along_outline = false;  // it or the sender is a wall or membrane: no vector, and faces is known
};

/// What matters of a receiver when a message arrives, in a quarter of the memory.
struct Hearer {
    std::uint32_t robot : 28;
    std::uint32_t faces : 4;  // bit d: its face d receives
};
static_assert(sizeof(Hearer) == sizeof(std::uint32_t) && kMostFaces <= 4);

class ReceiverCache {
public:
    /// Empties the cache, for `robot_count` robots.
    void clear(std::size_t robot_count);

    struct List {
        std::uint32_t changes = 0;  // of NeighbourCells, when the receivers were found
        float range_mm = 0.0F;      // 0: nothing is cached
        std::uint32_t first = 0;    // in the pool
        std::uint32_t count = 0;
        std::uint32_t room = 0;  // to which the list may grow in place
        std::uint8_t emitters = 0;
    };

    /// The cached receivers of such a transmission, up to date or not; nullptr: none.
    List const* find(std::uint32_t robot, std::uint8_t emitters, float range_mm) const {
        std::vector<List> const& lists = lists_[kind_of(emitters)];
        if (lists.empty()) {
            return nullptr;
        }
        List const& list = lists[robot];
        return list.range_mm == range_mm && list.emitters == emitters ? &list : nullptr;
    }

    std::span<Receiver const> receivers(List const& list) const {
        return std::span(pool_).subspan(list.first, list.count);
    }

    /// The same receivers, in the same order.
    std::span<Hearer const> hearers(List const& list) const {
        return std::span(hearers_).subspan(list.first, list.count);
    }

    /// Replaces the cached receivers of such a transmission, unless there are too many. Their faces are known.
    void store(std::uint32_t robot, std::uint8_t emitters, float range_mm, std::uint32_t changes,
               std::span<Receiver const> receivers);

private:
    /// Each robot has a list for each single emitter, and one for all other combinations.
    static constexpr std::size_t kKinds = 1 + kMostFaces;
    static std::size_t kind_of(std::uint8_t emitters) {
        bool const is_one = emitters != 0 && (emitters & (emitters - 1U)) == 0;
        return is_one ? static_cast<std::size_t>(1 + std::countr_zero(emitters)) : 0;
    }

    bool make_room(List& list, std::size_t count);

    std::size_t robot_count_ = 0;
    std::array<std::vector<List>, kKinds> lists_;  // by robot; empty before the first such transmission
    std::vector<Receiver> pool_;
    std::vector<Hearer> hearers_;  // of the pool
    std::size_t in_use_ = 0;       // size of the pool in use; the rest belonged to lists that have grown
};

}  // namespace pogosim
