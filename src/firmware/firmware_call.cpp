#include "firmware/firmware_call.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

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

namespace {

constexpr std::uint32_t kRegisters = 0xf0000000;  // of a robot's hardware, from here on

std::string text_of_access(std::uint32_t address) {
    if (address >= kRegisters) {
        return fmt::format(
            "it accessed 0x{:08x}, a register of the robot's hardware: functions of the library are simulated, but not "
            "the chips behind them",
            address);
    }
    return fmt::format("it accessed 0x{:08x}, where there is no memory: a pointer is wrong", address);
}

std::uint32_t word_at_pc(FirmwareRobot const& robot) {
    std::array<std::byte, 4> word{};
    robot.memory.read(robot.core.pc, word);
    return read_little_endian<4>(word.data());
}

std::string text_of_word(FirmwareRobot const& robot, Firmware const& firmware) {
    FirmwareSymbol const* const function = firmware.function_at(robot.core.pc);
    if (is_without_code(robot) && function != nullptr) {
        return function->name == "abort" ? "it called abort(), as assert() does when its condition is false"
                                         : fmt::format("it called {}(), which is not simulated", function->name);
    }
    return fmt::format("it got to 0x{:08x}, where 0x{:08x} is no instruction of the robot's processor (rv32im)",
                       robot.core.pc, word_at_pc(robot));
}

}  // namespace

bool is_without_code(FirmwareRobot const& robot) {
    constexpr std::uint32_t unimp = 0xc0001073;
    return word_at_pc(robot) == unimp;
}

std::string text_of(Stop const& stop, FirmwareRobot const& robot, Firmware const& firmware) {
    switch (stop.reason) {
        case StopReason::unaligned_access:
            return fmt::format("it accessed 0x{:08x}, which is no multiple of the size of what it expected there",
                               stop.address);
        case StopReason::outside_access:
            return text_of_access(stop.address);
        case StopReason::store_into_flash:
            return fmt::format("it wrote to 0x{:08x}, which is in flash: that can only be read", stop.address);
        case StopReason::store_into_code:
            return fmt::format("it wrote to 0x{:08x}, where its program is: a pointer is NULL or wrong", stop.address);
        case StopReason::jump_outside:
            return fmt::format(
                "it jumped to 0x{:08x}, where there is no code: a pointer to a function is NULL or wrong, or the stack "
                "was overwritten",
                stop.address);
        case StopReason::ecall:
            return "it executed ecall, which robots do not have";
        case StopReason::ebreak:
            return "it executed ebreak, where programs give up";
        default:
            return text_of_word(robot, firmware);
    }
}

std::string text_of(WrongAddress const& wrong) {
    return fmt::format("it gave {}() the address 0x{:08x}, {}", wrong.function, wrong.address, wrong.why);
}

CallOutcome do_nothing(FirmwareCall& /*call*/) {
    return CallOutcome::returns;
}

std::span<LibraryFunction const> library_functions() {
    static std::vector<LibraryFunction> const all = [] {
        std::vector<LibraryFunction> joined;
        for (auto const part : {clock_functions(), console_functions(), device_functions(), flash_functions(),
                                helper_functions(), infrared_functions()}) {
            joined.insert(joined.end(), part.begin(), part.end());
        }
        return joined;
    }();
    return all;
}

}  // namespace pogosim
