// The memory of a simulated robot's processor: its own RAM, and a flash that it can only read.
//
// Robots of a firmware begin with the same contents, an image. A robot gets a copy of a page when it first writes to
// it; what it never writes to (its program, constants, unused memory) exists once for all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace pogosim {

inline constexpr std::uint32_t kMemoryBytes = 131072;     // of a Pogobot; key 'memory_bytes' of a robot model
inline constexpr std::uint32_t kFlashAddress = 0x200000;  // of a Pogobot
inline constexpr std::uint32_t kFlashBytes = 0x200000;    // of a Pogobot
inline constexpr std::uint32_t kPageBytes = 1024;

/// What all robots of a firmware begin with. Sizes count in whole words: a part of a word at the end is no memory.
struct MemoryImage {
    std::uint32_t address = 0;  // a multiple of 4
    std::vector<std::byte> bytes = std::vector<std::byte>(kMemoryBytes);
    std::uint32_t flash_address = kFlashAddress;  // a multiple of 4
    std::vector<std::byte> flash;                 // empty: none
};

/// Why memory could not be accessed. An address that is both unaligned and outside is unaligned.
enum class AccessFault : std::uint8_t { none, unaligned, outside, read_only };

class Memory {
public:
    explicit Memory(std::shared_ptr<MemoryImage const> image);

    /// Where the aligned Bytes (1, 2 or 4) at an address are, to be read now; null if that is a fault.
    template <std::uint32_t Bytes>
    std::byte const* readable(std::uint32_t address) const {
        std::uint32_t const offset = address - address_;
        if (offset % Bytes != 0 || offset >= bytes_) [[unlikely]] {
            return in_flash(address, Bytes);
        }
        return pages_[offset / kPageBytes] + offset % kPageBytes;
    }

    /// The same, to be written now. Makes a copy of the page if the robot has none.
    template <std::uint32_t Bytes>
    std::byte* writable(std::uint32_t address) {
        std::uint32_t const offset = address - address_;
        if (offset % Bytes != 0 || offset >= bytes_) [[unlikely]] {
            return nullptr;
        }
        std::byte* const page = own_pages_[offset / kPageBytes].get();
        return (page != nullptr ? page : copy_page(offset / kPageBytes)) + offset % kPageBytes;
    }

    /// Why readable() or writable() gives null for an address.
    AccessFault fault_of_load(std::uint32_t address, std::uint32_t bytes) const;
    AccessFault fault_of_store(std::uint32_t address, std::uint32_t bytes) const;

    /// Copies bytes out of RAM or flash, or into RAM, at any alignment: for functions of the robot that run outside of
    /// its processor. On a fault, nothing is copied, and the first address that cannot be accessed is in the answer.
    struct Copied {
        AccessFault fault = AccessFault::none;
        std::uint32_t address = 0;
    };
    Copied read(std::uint32_t address, std::span<std::byte> bytes) const;
    Copied write(std::uint32_t address, std::span<std::byte const> bytes);

    /// How many pages are the robot's own.
    std::size_t copied_pages() const;

    /// How many pages the RAM has, and the bytes of one that is the robot's own; of others, none.
    std::uint32_t pages() const { return static_cast<std::uint32_t>(pages_.size()); }
    std::span<std::byte const> own_page(std::uint32_t page) const;

    /// Takes the bytes of a page, which becomes the robot's own, from the front of `bytes`.
    void write_page(std::uint32_t page, std::span<std::byte const>& bytes);

private:
    std::byte const* in_flash(std::uint32_t address, std::uint32_t bytes) const;
    std::uint32_t bytes_of_page(std::uint32_t page) const;
    std::byte* copy_page(std::uint32_t page);

    using Page = std::unique_ptr<std::byte[]>;

    std::uint32_t address_;
    std::uint32_t bytes_;
    std::vector<std::byte const*> pages_;  // of the robot or of the image
    std::vector<Page> own_pages_;          // null: of the image
    std::uint32_t flash_bytes_;
    std::shared_ptr<MemoryImage const> image_;
};

/// A little-endian number of Bytes bytes.
template <std::uint32_t Bytes>
std::uint32_t read_little_endian(std::byte const* bytes) {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < Bytes; ++i) {
        value |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
    }
    return value;
}

/// Writes the lowest Bytes bytes of a number.
template <std::uint32_t Bytes>
void write_little_endian(std::byte* bytes, std::uint32_t value) {
    for (std::uint32_t i = 0; i < Bytes; ++i) {
        bytes[i] = static_cast<std::byte>(value >> (8 * i));
    }
}

}  // namespace pogosim
