#include "firmware/stop_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace pogosim {

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

}  // namespace pogosim
