// The receivers of each robot's last transmissions, for as long as nothing in its reach changes.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec2.hpp"
#include "world/mailbox.hpp"

namespace pogosim {

/// One robot that a transmission reaches.
struct Receiver {
    std::uint32_t robot = 0;
    Vec2 from_emitter_mm{};  // from the emitter (the nearest one that sees it) to the receiver's centre
    // Bit d: its face d receives. 0 where Visibility::faces_of() tells: only those who get the message need to know.
    std::uint8_t faces = 0;
    std::uint8_t emitters = 0;      // bit d: emitter d reaches it, of those asked about
    bool is_along_outline = false;  // it or the sender is a wall or membrane: no vector, and faces is known
};

class ReceiverCache {
public:
    /// Forgets everything. `robot_count` robots.
    void clear(std::size_t robot_count);

    struct List {
        std::uint32_t changes = 0;  // of NeighbourCells, when the receivers were found
        float range_mm = 0.0F;      // 0: not known
        std::uint32_t first = 0;    // in the pool
        std::uint32_t count = 0;
        std::uint32_t room = 0;  // the list may grow to in place
        std::uint8_t emitters = 0;
    };

    /// What is known about the receivers of such a transmission, whether it still holds or not; nullptr: nothing.
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

    /// Keeps them in place of what was known for a transmission of this kind, unless they are too many.
    void store(std::uint32_t robot, std::uint8_t emitters, float range_mm, std::uint32_t changes,
               std::span<Receiver const> receivers);

private:
    /// Each robot has a list for transmissions by one of its emitters, for each of them, and one for all others.
    static constexpr std::size_t kKinds = 1 + kFaceCount;
    static std::size_t kind_of(std::uint8_t emitters) {
        return std::has_single_bit(emitters) ? static_cast<std::size_t>(1 + std::countr_zero(emitters)) : 0;
    }

    bool make_room(List& list, std::size_t count);

    std::size_t robot_count_ = 0;
    std::array<std::vector<List>, kKinds> lists_;  // by robot; empty before the first such transmission
    std::vector<Receiver> pool_;
    std::size_t in_use_ = 0;  // of the pool; the rest belonged to lists that have grown
};

}  // namespace pogosim
