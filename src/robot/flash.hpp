// The user's section of a robot's flash memory. Plain data: only pages that are not blank take memory, so a robot that
// never writes has none. How bits are written is that of NOR flash: erasing sets them, writing clears them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interface/pogobase_inside.hpp"

namespace pogosim {

inline constexpr std::size_t kFlashPageBytes = POGOBOT_USER_FLASH_PAGE_SIZE;
inline constexpr std::uint32_t kFlashPageCount = POGOBOT_USER_FLASH_PAGE_COUNT;
inline constexpr std::byte kErased{0xFF};

using FlashPage = std::array<std::byte, kFlashPageBytes>;

struct Flash {
    std::vector<std::uint16_t> slot{};  // of each page: 1 + its index in `pages`, 0 for a blank one; empty: all blank
    std::vector<FlashPage> pages{};     // in the order of their first write
    std::uint64_t lost_writes = 0;      // after which a page did not contain what was written, see program_page()
};

// Numbers of pages are below kFlashPageCount.

/// Reads a page into kFlashPageBytes bytes.
void read_page(Flash const& flash, std::uint16_t page, std::byte* into);

/// Replaces a page by kFlashPageBytes bytes.
void overwrite_page(Flash& flash, std::uint16_t page, std::byte const* data);

/// Clears the bits of a page that are 0 in `data`, as the robot does. False, and counted, if a bit that is 1 in `data`
/// was 0 and remains so.
bool program_page(Flash& flash, std::uint16_t page, std::byte const* data);

/// Erases everything. What was counted stays.
void erase(Flash& flash);

/// Whether all bytes of a page are erased.
bool is_blank(std::span<std::byte const> page);

/// The pages that are not blank, ascending.
std::vector<std::uint16_t> written_pages(Flash const& flash);

/// The bytes of one of these.
inline FlashPage const& page_at(Flash const& flash, std::uint16_t page) {
    return flash.pages[flash.slot[page] - 1U];
}

}  // namespace pogosim
