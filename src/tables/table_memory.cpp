#include "tables/table_memory.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

namespace pogosim {

namespace {

constexpr std::int64_t kUsualAlignment = arrow::kDefaultBufferAlignment;

/// The exponent of the smallest power of two that holds so many bytes.
std::size_t exponent_for(std::int64_t size) {
    auto const bytes = static_cast<std::uint64_t>(std::max<std::int64_t>(size, kUsualAlignment));
    return static_cast<std::size_t>(std::bit_width(bytes - 1));
}

/// What stands before a block.
struct Head {
    std::size_t exponent;  // of its capacity
    std::uint8_t* next;    // of the blocks that are kept
};
static_assert(sizeof(Head) <= kUsualAlignment);

Head& head_of(std::uint8_t* block) {
    return *reinterpret_cast<Head*>(block - kUsualAlignment);
}

std::int64_t capacity_of(std::uint8_t* block) {
    return std::int64_t{1} << head_of(block).exponent;
}

// No machine has more for one table; sanitizers end a program that asks for more.
constexpr std::size_t kMostExponent = 39;

/// Null: there is not enough memory.
std::uint8_t* new_block(std::size_t exponent) {
    if (exponent > kMostExponent) {
        return nullptr;
    }
    auto const head_bytes = static_cast<std::size_t>(kUsualAlignment);
    void* const memory = std::aligned_alloc(head_bytes, head_bytes + (std::size_t{1} << exponent));
    return memory != nullptr
               ? reinterpret_cast<std::uint8_t*>(new (memory) Head{.exponent = exponent, .next = nullptr}) + head_bytes
               : nullptr;
}

}  // namespace

arrow::Status TableMemory::Allocate(std::int64_t size, [[maybe_unused]] std::int64_t alignment, std::uint8_t** out) {
    assert(size >= 0 && alignment <= kUsualAlignment);
    std::size_t const exponent = exponent_for(size);
    if (std::uint8_t* const first = kept_[exponent]; first != nullptr) {
        *out = first;
        kept_[exponent] = head_of(first).next;
    } else {
        *out = new_block(exponent);
        if (*out == nullptr) {
            ReleaseUnused();
            *out = new_block(exponent);
        }
        if (*out == nullptr) {
            return arrow::Status::OutOfMemory("no memory for ", size, " bytes");
        }
    }
    count(size);
    return arrow::Status::OK();
}

arrow::Status TableMemory::Reallocate(std::int64_t old_size, std::int64_t new_size, std::int64_t alignment,
                                      std::uint8_t** block) {
    if (new_size <= capacity_of(*block)) {
        count(new_size - old_size);
        return arrow::Status::OK();
    }
    std::uint8_t* larger = nullptr;
    ARROW_RETURN_NOT_OK(Allocate(new_size, alignment, &larger));
    std::memcpy(larger, *block, static_cast<std::size_t>(std::min(old_size, new_size)));
    Free(*block, old_size, alignment);
    *block = larger;
    return arrow::Status::OK();
}

void TableMemory::Free(std::uint8_t* block, std::int64_t size, std::int64_t /*alignment*/) {
    Head& head = head_of(block);
    head.next = std::exchange(kept_[head.exponent], block);
    bytes_in_use_ -= size;
}

void TableMemory::ReleaseUnused() {
    for (auto& kept : kept_) {
        while (kept != nullptr) {
            std::free(std::exchange(kept, head_of(kept).next) - kUsualAlignment);
        }
    }
}

void TableMemory::count(std::int64_t more_bytes) {
    bytes_in_use_ += more_bytes;
    most_bytes_in_use_ = std::max(most_bytes_in_use_, bytes_in_use_);
    total_bytes_ += std::max<std::int64_t>(more_bytes, 0);
    ++allocations_;
}

}  // namespace pogosim
