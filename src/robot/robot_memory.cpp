#include "robot/robot_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <new>

#include "base/counted.hpp"
#include "base/memory.hpp"
#include "process/program_memory.hpp"

namespace pogosim {

namespace {

// Four words at any address. Written out, since sanitizers replace memcpy() and memcmp() with their own functions.
using Words = std::uint64_t __attribute__((vector_size(16), may_alias, aligned(1)));
constexpr std::size_t kWordsPerBlock = 4;
constexpr std::size_t kBlocksAtOnce = 8;

POGOSIM_SEES_ALL_BYTES inline void copy_block(std::byte* to, std::byte const* from) {
    auto* const target = reinterpret_cast<Words*>(to);
    auto const* const source = reinterpret_cast<Words const*>(from);
    Words const first = source[0];
    Words const second = source[1];
    Words const third = source[2];
    Words const fourth = source[3];
    target[0] = first;
    target[1] = second;
    target[2] = third;
    target[3] = fourth;
}

POGOSIM_SEES_ALL_BYTES inline bool is_same_block(std::byte const* a, std::byte const* b) {
    auto const* const left = reinterpret_cast<Words const*>(a);
    auto const* const right = reinterpret_cast<Words const*>(b);
    Words difference = left[0] ^ right[0];
    for (std::size_t i = 1; i < kWordsPerBlock; ++i) {
        difference |= left[i] ^ right[i];
    }
    return (difference[0] | difference[1]) == 0;
}

/// Whether kBlocksAtOnce blocks are the same.
POGOSIM_SEES_ALL_BYTES inline bool are_same_blocks(std::byte const* a, std::byte const* b) {
    auto const* left = reinterpret_cast<Words const*>(a);
    auto const* right = reinterpret_cast<Words const*>(b);
    Words even = {};
    Words odd = {};
    for (std::size_t i = 0; i < kBlocksAtOnce * kWordsPerBlock; i += 2) {
        even |= left[i] ^ right[i];
        odd |= left[i + 1] ^ right[i + 1];
    }
    even |= odd;
    return (even[0] | even[1]) == 0;
}

POGOSIM_SEES_ALL_BYTES bool is_same(std::byte const* a, std::byte const* b, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        if (*const_cast<std::byte const volatile*>(a + i) != b[i]) {
            return false;
        }
    }
    return true;
}

constexpr std::uint64_t kTicksBetweenLooks = 64;  // of each robot

}  // namespace

RobotMemory::RobotMemory(std::span<std::span<std::byte> const> pieces, std::uint32_t robots) : robots_(robots) {
    for (std::span<std::byte> const piece : pieces) {
        for (std::size_t at = 0; at < piece.size(); at += kBlockBytes) {
            std::size_t const bytes = std::min(kBlockBytes, piece.size() - at);
            blocks_.push_back({.place = piece.data() + at, .bytes = static_cast<std::uint32_t>(bytes), .slot = kSame});
        }
    }
    first_.resize(blocks_.size() * kBlockBytes);
    read_program(first_);
    same_ = other_ = first_;
    find_runs();
}

/// Copies all blocks of the program.
void RobotMemory::read_program(std::span<std::byte> to) const {
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        copy_program_bytes(to.data() + i * kBlockBytes, blocks_[i].place, blocks_[i].bytes);
    }
}

void RobotMemory::load(std::uint32_t copy) {
    if (copy == loaded_) {
        return;
    }
    if (++loads_ % (kTicksBetweenLooks * std::max(1U, robots_)) == 0) {
        find_same();
    }
    if (loaded_ == kNone || copy == kNone) {
        load_all(copy);
        return;
    }
    save();
    loaded_ = copy;
    std::byte const* from = slot(copy, 0);
    std::byte const* next = slot(copy + 1 < robots_ ? copy + 1 : 0, 0);  // most often the one that is loaded after it
    for (std::uint32_t const different : different_) {
        Block const& block = blocks_[different];
        __builtin_prefetch(next);
        next += kBlockBytes;
        put(block, from);
        from += kBlockBytes;
    }
}

void RobotMemory::begin_anew(std::uint32_t robot) {
    load(robot);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        put(blocks_[i], first_.data() + i * kBlockBytes);
    }
}

/// Switches from or to the copy that belongs to no robot, in which any block may differ.
void RobotMemory::load_all(std::uint32_t copy) {
    save();
    loaded_ = copy;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        put(blocks_[i], content(copy, i));
    }
}

/// The stored content of a block that is not in the program at present. `copy`: kNone for the copy that belongs to no
/// robot.
std::byte const* RobotMemory::content(std::uint32_t copy, std::size_t block) const {
    if (copy == kNone) {
        return other_.data() + block * kBlockBytes;
    }
    std::uint32_t const own_slot = blocks_[block].slot;
    return own_slot == kSame ? same_.data() + block * kBlockBytes : slot(copy, own_slot);
}

void RobotMemory::put(Block const& block, std::byte const* from) {
    if (block.bytes == kBlockBytes) {
        copy_block(block.place, from);
    } else {
        copy_program_bytes(block.place, from, block.bytes);
    }
}

void RobotMemory::take(Block const& block, std::byte* to) {
    if (block.bytes == kBlockBytes) {
        copy_block(to, block.place);
    } else {
        copy_program_bytes(to, block.place, block.bytes);
    }
}

bool RobotMemory::is_in_program(Block const& block, std::byte const* bytes) {
    return block.bytes == kBlockBytes ? is_same_block(block.place, bytes) : is_same(block.place, bytes, block.bytes);
}

void RobotMemory::save() {
    if (loaded_ == kNone) {
        read_program(other_);
        return;
    }
    note_changes();
    std::byte* to = slot(loaded_, 0);
    for (std::uint32_t const different : different_) {
        Block const& block = blocks_[different];
        if (!is_in_program(block, to)) {  // not written: so it need not go back to slower memory
            take(block, to);
        }
        to += kBlockBytes;
    }
}

/// Looks for changes in blocks that are the same for all, several at once.
void RobotMemory::note_changes() {
    std::size_t const changes = different_.size();
    for (Run const& run : same_runs_) {
        std::size_t block = run.first;
        for (; block + kBlocksAtOnce <= run.last; block += kBlocksAtOnce) {
            if (!are_same_blocks(blocks_[block].place, same_.data() + block * kBlockBytes)) {
                note_changes_between(block, block + kBlocksAtOnce);
            }
        }
        note_changes_between(block, run.last);
    }
    if (different_.size() != changes) {
        find_runs();
    }
}

void RobotMemory::note_changes_between(std::size_t first, std::size_t last) {
    for (std::size_t block = first; block < last; ++block) {
        if (!is_in_program(blocks_[block], same_.data() + block * kBlockBytes)) {
            note_change(static_cast<std::uint32_t>(block));
        }
    }
}

void RobotMemory::find_runs() {
    same_runs_.clear();
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
        if (blocks_[block].slot != kSame) {
            continue;
        }
        bool const is_next = !same_runs_.empty() && same_runs_.back().last == block &&
                             blocks_[block - 1].place + kBlockBytes == blocks_[block].place;
        if (!is_next) {
            same_runs_.push_back({.first = block, .last = block});
        }
        ++same_runs_.back().last;
    }
}

/// A robot has changed a block that is the same for all: from now on, each robot has its own.
void RobotMemory::note_change(std::uint32_t block) {
    auto const slots = static_cast<std::uint32_t>(different_.size());
    if (slots == capacity_) {
        make_room(std::max(8U, 2 * capacity_));
    }
    different_.push_back(block);
    blocks_[block].slot = slots;
    for (std::uint32_t robot = 0; robot < robots_; ++robot) {
        copy_block(slot(robot, slots), same_.data() + std::size_t{block} * kBlockBytes);
    }
}

void RobotMemory::make_room(std::uint32_t capacity) {
    std::size_t const bytes = std::size_t{capacity} * kBlockBytes;
    std::size_t const used_bytes = copied_bytes();
    auto const purpose = [&] {
        return fmt::format("the own memory (robot_memory: own) of {}, {} bytes each", counted(robots_, "robot"), bytes);
    };
    allocate_for(purpose, static_cast<double>(bytes) * robots_, [&] {
        if (bytes > std::numeric_limits<std::ptrdiff_t>::max() / std::max(1U, robots_)) {
            throw std::bad_alloc();
        }
        GuardedMemory larger(bytes * robots_);
        for (std::uint32_t robot = 0; robot < robots_ && used_bytes > 0; ++robot) {
            std::memcpy(larger.data() + robot * bytes, slot(robot, 0), used_bytes);
        }
        copies_ = std::move(larger);
    });
    capacity_ = capacity;
}

/// Blocks that all robots have set to the same bytes, such as a table that each has computed, need not be copied any
/// more.
void RobotMemory::find_same() {
    save();
    std::vector<std::uint32_t> still_different;
    for (std::uint32_t const block : different_) {
        std::uint32_t const from = blocks_[block].slot;
        if (is_same_for_all(from)) {
            copy_block(same_.data() + std::size_t{block} * kBlockBytes, slot(0, from));
            blocks_[block].slot = kSame;
            continue;
        }
        auto const to = static_cast<std::uint32_t>(still_different.size());
        for (std::uint32_t robot = 0; robot < robots_ && to != from; ++robot) {
            copy_block(slot(robot, to), slot(robot, from));
        }
        blocks_[block].slot = to;
        still_different.push_back(block);
    }
    different_ = std::move(still_different);
    find_runs();
}

bool RobotMemory::is_same_for_all(std::uint32_t own_slot) const {
    for (std::uint32_t robot = 1; robot < robots_; ++robot) {
        if (!is_same_block(slot(robot, own_slot), slot(0, own_slot))) {
            return false;
        }
    }
    return true;
}

void RobotMemory::read(std::uint32_t copy, std::byte const* place, std::span<std::byte> to) const {
    copy_program_bytes(to.data(), place, to.size());
    if (copy == loaded_) {
        return;
    }
    std::byte const* const end = place + to.size();
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        Block const& block = blocks_[i];
        std::byte const* const first = std::max<std::byte const*>(place, block.place);
        std::byte const* const last = std::min<std::byte const*>(end, block.place + block.bytes);
        if (first < last) {
            copy_program_bytes(to.data() + (first - place), content(copy, i) + (first - block.place),
                               static_cast<std::size_t>(last - first));
        }
    }
}

void RobotMemory::give_to_all(std::span<std::byte const> place) {
    std::byte const* const end = place.data() + place.size();
    std::erase_if(changed_, [&](ChangedByte const& byte) { return place.data() <= byte.place && byte.place < end; });
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        Block const& block = blocks_[i];
        std::byte const* const from = std::max<std::byte const*>(place.data(), block.place);
        std::byte const* const to = std::min<std::byte const*>(end, block.place + block.bytes);
        if (from < to) {
            auto const at = static_cast<std::size_t>(from - block.place);
            give(i, at, static_cast<std::size_t>(to - from));
            note_common_change(block.place + at, static_cast<std::size_t>(to - from));
        }
    }
}

/// Writes the bytes of a block from `at` on to all copies.
void RobotMemory::give(std::size_t block, std::size_t at, std::size_t bytes) {
    auto const [place, size, own_slot] = blocks_[block];
    std::size_t const offset = block * kBlockBytes + at;
    copy_program_bytes(same_.data() + offset, place + at, bytes);
    copy_program_bytes(other_.data() + offset, place + at, bytes);
    for (std::uint32_t robot = 0; robot < robots_ && own_slot != kSame; ++robot) {
        copy_program_bytes(slot(robot, own_slot) + at, place + at, bytes);
    }
}

void RobotMemory::begin_common_change() {
    before_.resize(first_.size());
    read_program(before_);
}

void RobotMemory::end_common_change() {
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        for (std::size_t at = 0; at < blocks_[i].bytes; ++at) {
            std::byte* const place = blocks_[i].place + at;
            if (!is_same(place, before_.data() + i * kBlockBytes + at, 1)) {
                give(i, at, 1);
                note_common_change(place, 1);
            }
        }
    }
}

/// The last change of a byte is the one that counts.
void RobotMemory::note_common_change(std::byte* place, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) {
        copy_program_bytes(&changed_.emplace_back(ChangedByte{.place = place + i}).value, place + i, 1);
    }
}

void RobotMemory::repeat_common_changes() {
    for (ChangedByte const& byte : changed_) {
        copy_program_bytes(byte.place, &byte.value, 1);
    }
}

std::size_t RobotMemory::offset_of(std::byte const* place) const {
    auto const found = std::ranges::find_if(
        blocks_, [place](Block const& block) { return place >= block.place && place < block.place + block.bytes; });
    assert(found != blocks_.end());
    return static_cast<std::size_t>(found - blocks_.begin()) * kBlockBytes +
           static_cast<std::size_t>(place - found->place);
}

bool RobotMemory::fits(Saved const& saved) const {
    auto const is_block = [this](std::uint32_t block) { return block < blocks_.size(); };
    return saved.same.size() == first_.size() && saved.other.size() == first_.size() &&
           saved.copies.size() == robots_ * saved.different.size() * kBlockBytes &&
           std::ranges::all_of(saved.different, is_block);
}

RobotMemory::Saved RobotMemory::save_all() {
    load(kNone);
    Saved saved{.same = same_, .other = other_, .different = different_, .copies = {}, .changed = changed_};
    saved.copies.reserve(robots_ * copied_bytes());
    for (std::uint32_t robot = 0; robot < robots_; ++robot) {
        saved.copies.insert(saved.copies.end(), slot(robot, 0), slot(robot, 0) + copied_bytes());
    }
    return saved;
}

void RobotMemory::restore_all(Saved const& saved) {
    load(kNone);
    same_ = saved.same;
    other_ = saved.other;
    changed_ = saved.changed;
    for (std::uint32_t const block : different_) {
        blocks_[block].slot = kSame;
    }
    if (saved.different.size() > capacity_) {  // saved by another process
        different_.clear();
        make_room(static_cast<std::uint32_t>(saved.different.size()));
    }
    different_ = saved.different;
    for (std::uint32_t own_slot = 0; own_slot < different_.size(); ++own_slot) {
        blocks_[different_[own_slot]].slot = own_slot;
    }
    std::byte const* from = saved.copies.data();
    for (std::uint32_t robot = 0; robot < robots_ && copied_bytes() > 0; ++robot, from += copied_bytes()) {
        std::memcpy(slot(robot, 0), from, copied_bytes());
    }
    find_runs();
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        put(blocks_[i], other_.data() + i * kBlockBytes);
    }
}

std::vector<RobotMemory::Part> RobotMemory::changed_parts(std::uint32_t copy) {
    save();
    std::vector<Part> parts;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        std::span const bytes(content(copy, i), blocks_[i].bytes);
        if (!std::ranges::equal(bytes, std::span(first_).subspan(i * kBlockBytes, bytes.size()))) {
            parts.push_back({.offset = i * kBlockBytes, .bytes = bytes});
        }
    }
    return parts;
}

}  // namespace pogosim
