// The user's flash memory, as plain data and through the functions of a robot.
#include "device/flash.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace pogosim {
namespace {

FlashPage filled(std::uint8_t value) {
    FlashPage page;
    page.fill(std::byte{value});
    return page;
}

FlashPage read(Flash const& flash, std::uint16_t page) {
    FlashPage result = filled(0x5A);
    read_page(flash, page, result.data());
    return result;
}

void overwrite(Flash& flash, std::uint16_t page, FlashPage const& data) {
    overwrite_page(flash, page, data.data());
}

bool program(Flash& flash, std::uint16_t page, FlashPage const& data) {
    return program_page(flash, page, data.data());
}

TEST(Flash, FreshPagesAreErasedAndTakeNoMemory) {
    Flash const flash;
    for (std::uint32_t page = 0; page < kFlashPageCount; ++page) {
        ASSERT_EQ(read(flash, static_cast<std::uint16_t>(page)), filled(0xFF)) << page;
    }
    EXPECT_TRUE(flash.slot.empty());
    EXPECT_TRUE(flash.pages.empty());
}

TEST(Flash, EveryPageKeepsItsOwnBytes) {
    Flash flash;
    auto const mark = [](std::uint32_t page) {
        FlashPage data = filled(static_cast<std::uint8_t>(page % 251));
        std::memcpy(data.data(), &page, sizeof(page));
        return data;
    };
    for (std::uint32_t page = kFlashPageCount; page-- > 0;) {
        overwrite(flash, static_cast<std::uint16_t>(page), mark(page));
    }
    for (std::uint32_t page = 0; page < kFlashPageCount; ++page) {
        ASSERT_EQ(read(flash, static_cast<std::uint16_t>(page)), mark(page));
    }
    EXPECT_EQ(written_pages(flash).size(), kFlashPageCount);
}

TEST(Flash, OnlyWrittenPagesTakeMemory) {
    Flash flash;
    for (int i = 0; i < 100; ++i) {
        overwrite(flash, 17, filled(1));
        overwrite(flash, 5887, filled(2));
        overwrite(flash, 3000, filled(0xFF));  // blank, and was
    }
    EXPECT_EQ(flash.pages.size(), 2U);
    EXPECT_EQ(written_pages(flash), (std::vector<std::uint16_t>{17, 5887}));
}

TEST(Flash, OverwritingSetsBitsToo) {
    Flash flash;
    overwrite(flash, 3, filled(0x00));
    overwrite(flash, 3, filled(0xA5));
    EXPECT_EQ(read(flash, 3), filled(0xA5));
    overwrite(flash, 3, filled(0xFF));
    EXPECT_EQ(read(flash, 3), filled(0xFF));
    EXPECT_TRUE(written_pages(flash).empty());
}

TEST(Flash, ProgrammingClearsBitsOnly) {
    for (int old = 0; old < 256; old += 5) {
        for (int wanted = 0; wanted < 256; ++wanted) {
            Flash flash;
            EXPECT_TRUE(program(flash, 9, filled(static_cast<std::uint8_t>(old))));
            bool const is_as_written = program(flash, 9, filled(static_cast<std::uint8_t>(wanted)));
            ASSERT_EQ(read(flash, 9), filled(static_cast<std::uint8_t>(old & wanted)));
            ASSERT_EQ(is_as_written, (old & wanted) == wanted);
            ASSERT_EQ(flash.lost_writes, is_as_written ? 0U : 1U);
        }
    }
}

TEST(Flash, LostWritesAreCounted) {
    Flash flash;
    program(flash, 40, filled(0x0F));
    program(flash, 20, filled(0x0F));
    program(flash, 40, filled(0x0F));  // the same again loses nothing
    EXPECT_EQ(flash.lost_writes, 0U);
    program(flash, 40, filled(0xF0));
    program(flash, 20, filled(0xF0));
    program(flash, 40, filled(0xFF));
    EXPECT_EQ(flash.lost_writes, 3U);
    erase(flash);
    EXPECT_EQ(flash.lost_writes, 3U);
}

TEST(Flash, ErasingSetsAllBits) {
    Flash flash;
    program(flash, 0, filled(0));
    program(flash, 5887, filled(0));
    erase(flash);
    EXPECT_EQ(read(flash, 0), filled(0xFF));
    EXPECT_EQ(read(flash, 5887), filled(0xFF));
    EXPECT_TRUE(flash.pages.empty());
    EXPECT_TRUE(program(flash, 0, filled(0xFE)));
    EXPECT_EQ(read(flash, 0), filled(0xFE));
}

TEST(Flash, CopiesAreIndependent) {
    Flash one;
    overwrite(one, 1, filled(1));
    Flash other = one;
    overwrite(other, 1, filled(2));
    erase(one);
    EXPECT_EQ(read(other, 1), filled(2));
    EXPECT_EQ(read(one, 1), filled(0xFF));
}

}  // namespace
}  // namespace pogosim
