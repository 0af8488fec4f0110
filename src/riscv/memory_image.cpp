#include "riscv/memory_image.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pogosim {

namespace {

std::uint32_t whole_words(std::vector<std::byte> const& bytes) {
    assert(bytes.size() < (std::uint64_t{1} << 32));
    return static_cast<std::uint32_t>(bytes.size()) & ~3U;
}

}  // namespace

Memory::Memory(std::shared_ptr<MemoryImage const> image)
    : address_(image->address),
      bytes_(whole_words(image->bytes)),
      pages_((bytes_ + kPageBytes - 1) / kPageBytes),
      own_pages_(pages_.size()),
      flash_bytes_(whole_words(image->flash)),
      image_(std::move(image)) {
    assert(address_ % 4 == 0 && image_->flash_address % 4 == 0);
    for (std::size_t page = 0; page < pages_.size(); ++page) {
        pages_[page] = image_->bytes.data() + page * kPageBytes;
    }
}

std::byte const* Memory::in_flash(std::uint32_t address, std::uint32_t bytes) const {
    std::uint32_t const offset = address - image_->flash_address;
    return offset % bytes == 0 && offset < flash_bytes_ ? image_->flash.data() + offset : nullptr;
}

std::uint32_t Memory::bytes_of_page(std::uint32_t page) const {
    return std::min(kPageBytes, bytes_ - page * kPageBytes);
}

std::span<std::byte const> Memory::own_page(std::uint32_t page) const {
    std::byte const* const bytes = own_pages_[page].get();
    return {bytes, bytes == nullptr ? 0 : bytes_of_page(page)};
}

void Memory::write_page(std::uint32_t page, std::span<std::byte const>& bytes) {
    std::byte* const own = own_pages_[page] ? own_pages_[page].get() : copy_page(page);
    std::copy_n(bytes.data(), bytes_of_page(page), own);
    bytes = bytes.subspan(bytes_of_page(page));
}

std::byte* Memory::copy_page(std::uint32_t page) {
    std::size_t const bytes = bytes_of_page(page);
    own_pages_[page] = std::make_unique<std::byte[]>(bytes);
    std::copy_n(pages_[page], bytes, own_pages_[page].get());
    pages_[page] = own_pages_[page].get();
    return own_pages_[page].get();
}

AccessFault Memory::fault_of_load(std::uint32_t address, std::uint32_t bytes) const {
    if (address % bytes != 0) {
        return AccessFault::unaligned;
    }
    bool const is_inside = address - address_ < bytes_ || in_flash(address, bytes) != nullptr;
    return is_inside ? AccessFault::none : AccessFault::outside;
}

AccessFault Memory::fault_of_store(std::uint32_t address, std::uint32_t bytes) const {
    AccessFault const fault = fault_of_load(address, bytes);
    bool const is_in_flash = fault == AccessFault::none && address - address_ >= bytes_;
    return is_in_flash ? AccessFault::read_only : fault;
}

Memory::Copied Memory::read(std::uint32_t address, std::span<std::byte> bytes) const {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        auto const at = static_cast<std::uint32_t>(address + i);
        if (AccessFault const fault = fault_of_load(at, 1); fault != AccessFault::none) {
            return {fault, at};
        }
    }
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = *readable<1>(static_cast<std::uint32_t>(address + i));
    }
    return {};
}

Memory::Copied Memory::write(std::uint32_t address, std::span<std::byte const> bytes) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        auto const at = static_cast<std::uint32_t>(address + i);
        if (AccessFault const fault = fault_of_store(at, 1); fault != AccessFault::none) {
            return {fault, at};
        }
    }
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        *writable<1>(static_cast<std::uint32_t>(address + i)) = bytes[i];
    }
    return {};
}

std::size_t Memory::copied_pages() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(own_pages_, [](Page const& page) { return page != nullptr; }));
}

}  // namespace pogosim
