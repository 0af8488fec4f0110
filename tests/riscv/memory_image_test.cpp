#include "riscv/memory_image.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

using namespace pogosim;

std::shared_ptr<MemoryImage const> numbered_image(std::size_t bytes) {
    MemoryImage image;
    image.bytes.resize(bytes);
    image.flash.resize(64);
    for (std::size_t i = 0; i < bytes; ++i) {
        image.bytes[i] = static_cast<std::byte>(i % 251);
    }
    for (std::size_t i = 0; i < image.flash.size(); ++i) {
        image.flash[i] = static_cast<std::byte>(100 + i);
    }
    return std::make_shared<MemoryImage const>(std::move(image));
}

TEST(RobotMemory, PageIsCopiedWhenItIsFirstWritten) {
    auto const image = numbered_image(kMemoryBytes);
    Memory memory(image);
    Memory other(image);
    for (std::uint32_t address = 0; address < kMemoryBytes; address += 4) {
        ASSERT_EQ(memory.readable<4>(address), image->bytes.data() + address);
    }
    EXPECT_EQ(memory.copied_pages(), 0U);

    write_little_endian<4>(memory.writable<4>(5000), 0xdeadbeef);
    write_little_endian<1>(memory.writable<1>(5119), 7);
    EXPECT_EQ(memory.copied_pages(), 1U);
    write_little_endian<1>(memory.writable<1>(5120), 7);
    EXPECT_EQ(memory.copied_pages(), 2U);

    EXPECT_EQ(read_little_endian<4>(memory.readable<4>(5000)), 0xdeadbeefU);
    EXPECT_EQ(*memory.readable<1>(4999), image->bytes[4999]);
    EXPECT_EQ(*memory.readable<1>(5004), image->bytes[5004]);
    EXPECT_EQ(other.copied_pages(), 0U);
    EXPECT_EQ(*other.readable<1>(5000), image->bytes[5000]);
}

TEST(RobotMemory, NumbersAreLittleEndian) {
    Memory memory(numbered_image(4096));
    write_little_endian<4>(memory.writable<4>(8), 0x04030201);
    EXPECT_EQ(read_little_endian<1>(memory.readable<1>(8)), 1U);
    EXPECT_EQ(read_little_endian<2>(memory.readable<2>(10)), 0x0403U);
    write_little_endian<2>(memory.writable<2>(8), 0xabcd);
    EXPECT_EQ(read_little_endian<4>(memory.readable<4>(8)), 0x0403abcdU);
}

TEST(RobotMemory, FaultsSayWhy) {
    Memory memory(numbered_image(4096));
    EXPECT_EQ(memory.readable<4>(4096), nullptr);
    EXPECT_EQ(memory.fault_of_load(4096, 4), AccessFault::outside);
    EXPECT_EQ(memory.readable<4>(4094), nullptr);
    EXPECT_EQ(memory.fault_of_load(4094, 4), AccessFault::unaligned);
    EXPECT_EQ(memory.readable<2>(0xffffffff), nullptr);
    EXPECT_EQ(memory.fault_of_store(0xffffffff, 2), AccessFault::unaligned);
    EXPECT_EQ(memory.writable<1>(0xffffffff), nullptr);
    EXPECT_EQ(memory.fault_of_store(0xffffffff, 1), AccessFault::outside);
    EXPECT_EQ(memory.fault_of_store(4092, 4), AccessFault::none);
    EXPECT_EQ(memory.copied_pages(), 0U);
}

TEST(RobotMemory, FlashIsOnlyRead) {
    Memory memory(numbered_image(4096));
    EXPECT_EQ(read_little_endian<4>(memory.readable<4>(kFlashAddress + 60)), 0xa3a2a1a0U);
    EXPECT_EQ(memory.readable<4>(kFlashAddress + 64), nullptr);
    EXPECT_EQ(memory.fault_of_load(kFlashAddress + 64, 4), AccessFault::outside);
    EXPECT_EQ(memory.writable<4>(kFlashAddress), nullptr);
    EXPECT_EQ(memory.fault_of_store(kFlashAddress, 4), AccessFault::read_only);
}

TEST(RobotMemory, SizeNeedNotBeWholePages) {
    Memory memory(numbered_image(kPageBytes + 10));  // two words and a half
    write_little_endian<4>(memory.writable<4>(kPageBytes + 4), 9);
    EXPECT_EQ(*memory.readable<1>(kPageBytes + 3), static_cast<std::byte>((kPageBytes + 3) % 251));
    EXPECT_EQ(memory.readable<1>(kPageBytes + 8), nullptr);
    EXPECT_EQ(memory.writable<2>(kPageBytes + 8), nullptr);
}

TEST(RobotMemory, BlocksAreCopiedAsAWholeOrNotAtAll) {
    Memory memory(numbered_image(4096));
    std::array<std::byte, 6> bytes{};
    EXPECT_EQ(memory.read(1021, bytes).fault, AccessFault::none);  // over the edge of a page, unaligned
    EXPECT_EQ(bytes[0], static_cast<std::byte>(1021 % 251));
    EXPECT_EQ(bytes[5], static_cast<std::byte>(1026 % 251));

    EXPECT_EQ(memory.write(2047, bytes).fault, AccessFault::none);
    EXPECT_EQ(*memory.readable<1>(2052), bytes[5]);
    EXPECT_EQ(memory.copied_pages(), 2U);

    auto const refused = memory.write(4092, bytes);
    EXPECT_EQ(refused.fault, AccessFault::outside);
    EXPECT_EQ(refused.address, 4096U);
    EXPECT_EQ(memory.copied_pages(), 2U);
    EXPECT_EQ(memory.write(kFlashAddress, bytes).fault, AccessFault::read_only);
}

}  // namespace
