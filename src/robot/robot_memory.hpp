// A copy of the program's variables for each robot. One copy at a time is in the program, where its code finds it.
//
// Most variables never change, or do not differ from robot to robot: only blocks (cache lines) that differ are copied.
// Which ones some robot has changed is seen by comparing all others with what they were before; that is fast, as it is
// the same memory for every robot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "process/program_memory.hpp"
#include "world/world.hpp"

namespace pogosim {

class RobotMemory {
public:
    static constexpr std::size_t kBlockBytes = 64;

    struct ChangedByte {
        std::byte* place = nullptr;  // in the program
        std::byte value{};
    };

    /// Makes `robots` copies of what is in these pieces of the program's memory now, and one more for code that belongs
    /// to no robot. The pieces must not overlap.
    RobotMemory(std::span<std::span<std::byte> const> pieces, std::uint32_t robots);

    /// Puts a copy into the program: that of a robot, or kNone. What is in the program belongs to the copy before.
    void load(std::uint32_t copy);

    /// Puts a robot's copy into the program, as it was in the beginning.
    void begin_anew(std::uint32_t robot);

    /// Reads what a robot's copy has at a place in the program, without loading the copy. Bytes outside variables are
    /// as the program has them.
    void read(std::uint32_t copy, std::byte const* place, std::span<std::byte> to) const;

    /// Copies what the program has in this place now to every copy. Bytes outside of its variables are ignored.
    void give_to_all(std::span<std::byte const> place);

    /// Changes that the program makes from here to the end of the common change are made in every copy.
    void begin_common_change();
    void end_common_change();

    /// Makes these common changes, and what was given to all, again in what the program has now.
    void repeat_common_changes();

    struct Part {
        std::size_t offset = 0;            // in all pieces, one after the other
        std::span<std::byte const> bytes;  // valid until the next change
    };
    /// The blocks in which a copy (of a robot, or kNone) differs from the beginning, ascending.
    std::vector<Part> changed_parts(std::uint32_t copy);

    /// What all copies are now.
    struct Saved {
        std::vector<std::byte> same;
        std::vector<std::byte> other;
        std::vector<std::uint32_t> different;
        std::vector<std::byte> copies;  // of the blocks that differ, robot by robot
        std::vector<ChangedByte> changed;
    };
    Saved save_all();
    void restore_all(Saved const& saved);

    /// Where a byte of Saved::same or Saved::other is in the program.
    std::byte* place_of(std::size_t offset) const { return blocks_[offset / kBlockBytes].place + offset % kBlockBytes; }

    /// The reverse, of a place in one of the blocks.
    std::size_t offset_of(std::byte const* place) const;

    /// Whether this memory can have such a state. One that another process has written may be of another program.
    bool fits(Saved const& saved) const;

    /// Bytes of one copy.
    std::size_t bytes() const { return first_.size(); }
    /// Number of blocks that are copied.
    std::size_t copied_bytes() const { return different_.size() * kBlockBytes; }

private:
    static constexpr std::uint32_t kSame = UINT32_MAX;

    struct Block {
        std::byte* place = nullptr;  // in the program
        std::uint32_t bytes = 0;     // kBlockBytes but at the end of a piece
        std::uint32_t slot = 0;      // of each robot; kSame: all robots have what is in same_
    };

    struct Run {  // of blocks that lie one behind the other
        std::size_t first = 0;
        std::size_t last = 0;  // not one of them
    };

    static void put(Block const& block, std::byte const* from);
    static void take(Block const& block, std::byte* to);
    static bool is_in_program(Block const& block, std::byte const* bytes);
    void read_program(std::span<std::byte> to) const;
    std::byte const* content(std::uint32_t copy, std::size_t block) const;
    void load_all(std::uint32_t copy);
    void save();
    void give(std::size_t block, std::size_t at, std::size_t bytes);
    void note_common_change(std::byte* place, std::size_t bytes);
    void note_changes();
    void note_changes_between(std::size_t first, std::size_t last);
    void note_change(std::uint32_t block);
    void find_runs();
    void make_room(std::uint32_t capacity);
    void find_same();
    bool is_same_for_all(std::uint32_t slot) const;
    std::byte* slot(std::uint32_t robot, std::uint32_t slot) const {
        return copies_.data() + (std::size_t{robot} * capacity_ + slot) * kBlockBytes;
    }

    std::uint32_t robots_;
    std::vector<Block> blocks_;
    std::vector<Run> same_runs_;            // the blocks that are the same for all robots
    std::vector<std::byte> first_;          // of all blocks, one after the other: what was there in the beginning
    std::vector<std::byte> same_;           // what all robots have, but for the blocks that differ
    std::vector<std::byte> other_;          // of code that is of no robot
    std::vector<std::byte> before_;         // a common change: what was in the program
    std::vector<ChangedByte> changed_;      // by common changes
    std::vector<std::uint32_t> different_;  // blocks, by slot
    std::uint32_t capacity_ = 0;            // slots of each robot
    GuardedMemory copies_;                  // slots of all, robot by robot
    std::uint32_t loaded_ = kNone;          // the copy that is in the program
    std::uint64_t loads_ = 0;
};

}  // namespace pogosim
