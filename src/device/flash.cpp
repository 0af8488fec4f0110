#include "device/flash.hpp"

#include <algorithm>
#include <cassert>

#include "interface/pogobase_inside.hpp"

namespace pogosim {

namespace {

static_assert(kFlashPageBytes == POGOBOT_USER_FLASH_PAGE_SIZE && kFlashPageCount == POGOBOT_USER_FLASH_PAGE_COUNT);

/// The page, or null: it is blank.
FlashPage const* find_page(Flash const& flash, std::uint16_t page) {
    assert(page < kFlashPageCount);
    return flash.slot.empty() || flash.slot[page] == 0 ? nullptr : &page_at(flash, page);
}

/// The page, which gets memory if it has none.
FlashPage& made_page(Flash& flash, std::uint16_t page) {
    if (flash.slot.empty()) {
        flash.slot.resize(kFlashPageCount);
    }
    std::uint16_t& slot = flash.slot[page];
    if (slot == 0) {
        flash.pages.emplace_back().fill(kErased);
        slot = static_cast<std::uint16_t>(flash.pages.size());
    }
    return flash.pages[slot - 1U];
}

}  // namespace

std::size_t allocated_bytes(Flash const& flash) {
    return flash.slot.capacity() * sizeof(flash.slot[0]) + flash.pages.capacity() * sizeof(FlashPage);
}

bool is_blank(std::span<std::byte const> page) {
    return std::ranges::all_of(page, [](std::byte byte) { return byte == kErased; });
}

void read_page(Flash const& flash, std::uint16_t page, std::byte* into) {
    FlashPage const* const found = find_page(flash, page);
    if (found == nullptr) {
        std::fill_n(into, kFlashPageBytes, kErased);
    } else {
        std::ranges::copy(*found, into);
    }
}

void overwrite_page(Flash& flash, std::uint16_t page, std::byte const* data) {
    if (find_page(flash, page) != nullptr || !is_blank({data, kFlashPageBytes})) {
        std::copy_n(data, kFlashPageBytes, made_page(flash, page).begin());
    }
}

bool program_page(Flash& flash, std::uint16_t page, std::byte const* data) {
    if (find_page(flash, page) == nullptr) {
        overwrite_page(flash, page, data);
        return true;
    }
    FlashPage& stored = made_page(flash, page);
    std::ranges::transform(stored, std::span(data, kFlashPageBytes), stored.begin(),
                           [](std::byte old, std::byte wanted) { return old & wanted; });
    bool const is_as_written = std::equal(stored.begin(), stored.end(), data);
    if (!is_as_written) {
        ++flash.lost_writes;
    }
    return is_as_written;
}

void erase(Flash& flash) {
    flash.slot.clear();
    flash.pages.clear();
}

bool write_page(World& world, std::size_t device, std::uint16_t page, std::byte const* data) {
    Flash& flash = world.devices.flash[device];
    bool const is_robot = device < world.robots.size();
    if (is_robot && world.spec_of(device).flash == FlashWrites::nor) {
        return program_page(flash, page, data);
    }
    overwrite_page(flash, page, data);
    return true;
}

std::vector<std::uint16_t> written_pages(Flash const& flash) {
    std::vector<std::uint16_t> pages;
    for (std::size_t page = 0; page < flash.slot.size(); ++page) {
        if (flash.slot[page] != 0 && !is_blank(flash.pages[flash.slot[page] - 1U])) {
            pages.push_back(static_cast<std::uint16_t>(page));
        }
    }
    return pages;
}

}  // namespace pogosim
