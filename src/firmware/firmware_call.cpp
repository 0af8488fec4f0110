#include "firmware/firmware_call.hpp"

#include <array>
#include <bit>
#include <utility>

namespace pogosim {

static_assert(std::endian::native == std::endian::little);  // functions of the library copy numbers as they are

std::uint32_t FirmwareCall::ticks() const {
    std::byte const* const place = program.ticks ? self.memory.readable<4>(*program.ticks) : nullptr;
    return place == nullptr ? 0 : read_little_endian<4>(place);
}

void FirmwareCall::warn_once(std::string_view kind, std::string text) const {
    out.said.push_back({robot, ticks(), Slip{function, {}, {}, kind}, std::move(text)});
}

void FirmwareCall::give_float(float result) const {
    give(std::bit_cast<std::uint32_t>(result));
}

void FirmwareCall::read(std::uint32_t address, std::span<std::byte> bytes) const {
    if (Memory::Copied const copied = self.memory.read(address, bytes); copied.fault != AccessFault::none) {
        throw WrongAddress{function, copied.address};
    }
}

void FirmwareCall::write(std::uint32_t address, std::span<std::byte const> bytes) const {
    if (program.firmware.code.overlaps(address, bytes.size())) {
        throw WrongAddress{function, address, "where its program is: it is NULL or wrong"};
    }
    if (Memory::Copied const copied = self.memory.write(address, bytes); copied.fault != AccessFault::none) {
        throw WrongAddress{function, copied.address};
    }
}

void FirmwareCall::require_aligned(std::uint32_t address) const {
    if (address % 4 != 0) {
        throw WrongAddress{function, address, "which is no multiple of 4, the size of what it expected there"};
    }
}

std::uint32_t FirmwareCall::read_word(std::uint32_t address) const {
    std::array<std::byte, 4> bytes{};
    require_aligned(address);
    read(address, bytes);
    return read_little_endian<4>(bytes.data());
}

void FirmwareCall::write_word(std::uint32_t address, std::uint32_t value) const {
    std::array<std::byte, 4> bytes{};
    require_aligned(address);
    write_little_endian<4>(bytes.data(), value);
    write(address, bytes);
}

}  // namespace pogosim
