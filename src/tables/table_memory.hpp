// Memory for the rows of tables.
#pragma once

#include <arrow/memory_pool.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace pogosim {

/// The C library's memory.
inline arrow::MemoryPool* table_memory() {
    return arrow::system_memory_pool();
}

/// The memory of one table. Blocks that are freed are kept for the next ones of their size, until the table ends: what
/// is given back to the system would have to be cleared, page by page, before it is used again, and that costs as much
/// as compressing the rows. It holds what the table ever needed at once; blocks have up to twice the size that was
/// asked for, of which the system provides the pages that are used.
///
///     │ head: its size, and the next one that is kept │ the block, a power of two │
///
/// Not thread-safe: as the table, it belongs to one thread at a time.
class TableMemory final : public arrow::MemoryPool {
public:
    TableMemory() = default;
    ~TableMemory() override { ReleaseUnused(); }

    TableMemory(TableMemory const&) = delete;
    TableMemory& operator=(TableMemory const&) = delete;

    using arrow::MemoryPool::Allocate;
    using arrow::MemoryPool::Free;
    using arrow::MemoryPool::Reallocate;

    /// `alignment`: a power of two.
    arrow::Status Allocate(std::int64_t size, std::int64_t alignment, std::uint8_t** out) override;

    /// A block that shrinks, or grows within its capacity, stays where it is.
    arrow::Status Reallocate(std::int64_t old_size, std::int64_t new_size, std::int64_t alignment,
                             std::uint8_t** block) override;
    void Free(std::uint8_t* block, std::int64_t size, std::int64_t alignment) override;

    /// Gives the blocks that are not in use back to the system.
    void ReleaseUnused() override;

    std::int64_t bytes_allocated() const override { return bytes_in_use_; }
    std::int64_t max_memory() const override { return most_bytes_in_use_; }
    std::int64_t total_bytes_allocated() const override { return total_bytes_; }
    std::int64_t num_allocations() const override { return allocations_; }
    std::string backend_name() const override { return "pogosim"; }

private:
    static constexpr std::size_t kSizes = 64;  // powers of two

    void count(std::int64_t more_bytes);

    std::array<std::uint8_t*, kSizes> kept_{};  // the first of each size, by its exponent
    std::int64_t bytes_in_use_ = 0;
    std::int64_t most_bytes_in_use_ = 0;
    std::int64_t total_bytes_ = 0;
    std::int64_t allocations_ = 0;
};

}  // namespace pogosim
