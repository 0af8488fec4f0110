#include "tables/table_memory.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>

namespace pogosim {
namespace {

std::uint8_t* allocated(TableMemory& memory, std::int64_t size) {
    std::uint8_t* block = nullptr;
    EXPECT_TRUE(memory.Allocate(size, &block).ok());
    return block;
}

TEST(TableMemory, GivesAFreedBlockToTheNextOneOfItsSize) {
    TableMemory memory;
    std::uint8_t* const first = allocated(memory, 100'000);
    memory.Free(first, 100'000);
    std::uint8_t* const second = allocated(memory, 70'000);
    EXPECT_EQ(second, first);
    std::uint8_t* const third = allocated(memory, 70'000);
    EXPECT_NE(third, second);
    memory.Free(second, 70'000);
    memory.Free(third, 70'000);
    EXPECT_EQ(memory.bytes_allocated(), 0);
    EXPECT_EQ(memory.max_memory(), 140'000);
}

TEST(TableMemory, KeepsTheBytesOfABlockThatGrowsAndOneThatShrinksInItsPlace) {
    TableMemory memory;
    std::uint8_t* block = allocated(memory, 1000);
    std::memset(block, 7, 1000);
    ASSERT_TRUE(memory.Reallocate(1000, 100'000, &block).ok());
    EXPECT_EQ(block[0], 7);
    EXPECT_EQ(block[999], 7);
    std::uint8_t* const before = block;
    ASSERT_TRUE(memory.Reallocate(100'000, 10, &block).ok());
    EXPECT_EQ(block, before);
    ASSERT_TRUE(memory.Reallocate(10, 100'000, &block).ok());
    EXPECT_EQ(block, before);
    EXPECT_EQ(memory.bytes_allocated(), 100'000);
    memory.Free(block, 100'000);
}

TEST(TableMemory, AlignsItsBlocks) {
    TableMemory memory;
    for (std::int64_t const size : {0, 1, 64, 65, 1000, 1 << 20}) {
        std::uint8_t* const block = allocated(memory, size);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % arrow::kDefaultBufferAlignment, 0U) << size;
        std::memset(block, 1, static_cast<std::size_t>(size));
        memory.Free(block, size);
    }
}

TEST(TableMemory, SaysThatThereIsNotEnough) {
    TableMemory memory;
    std::uint8_t* block = nullptr;
    EXPECT_TRUE(memory.Allocate(std::int64_t{1} << 60, &block).IsOutOfMemory());
    EXPECT_TRUE(memory.Allocate(std::numeric_limits<std::int64_t>::max(), &block).IsOutOfMemory());
    EXPECT_EQ(memory.bytes_allocated(), 0);
}

}  // namespace
}  // namespace pogosim
