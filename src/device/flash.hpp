// The user's section of a robot's flash memory. How bits are written is that of NOR flash: erasing sets them, writing
// clears them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

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

/// What it takes of the computer's memory.
std::size_t allocated_bytes(Flash const& flash);

/// Whether all bytes of a page are erased.
bool is_blank(std::span<std::byte const> page);

/// The pages that are not blank, ascending.
std::vector<std::uint16_t> written_pages(Flash const& flash);

/// The bytes of one of these.
inline FlashPage const& page_at(Flash const& flash, std::uint16_t page) {
    return flash.pages[flash.slot[page] - 1U];
}

/// Writes a page as `flash` of the robot's category says. False if a bit was lost, see program_page(). `device`: index
/// into World::devices; callback_global_step overwrites.
bool write_page(World& world, std::size_t device, std::uint16_t page, std::byte const* data);

}  // namespace pogosim
