// Firmware as files: what is read out of one, and that anything else is refused in one line.
#include "riscv/firmware_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/random.hpp"
#include "riscv/core.hpp"

namespace pogosim {
namespace {

using namespace std::string_view_literals;

using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kNoOperation = 0x00000013;  // addi x0, x0, 0
constexpr std::uint32_t kCodeAt = 0x100;

void put(Bytes& bytes, std::size_t at, std::uint32_t value, std::size_t size = 4) {
    bytes.resize(std::max(bytes.size(), at + size));
    for (std::size_t i = 0; i < size; ++i) {
        bytes[at + i] = static_cast<std::byte>(value >> (8 * i));
    }
}

// Places in the file that elf() makes.
constexpr std::size_t kSegment = 52;
constexpr std::size_t kSections = kSegment + 32;
constexpr std::size_t kCode = kSections + 4 * 40;
constexpr std::size_t kSymbols = kCode + 16;
constexpr std::size_t kNames = kSymbols + 4 * 16;
constexpr std::string_view kTexts = "\0main\0user_step\0mydata\0"sv;

void put_section(Bytes& file, std::size_t number, std::array<std::uint32_t, 6> const& type_to_link) {
    for (std::size_t i = 0; i < type_to_link.size(); ++i) {
        put(file, kSections + 40 * number + 4 + 4 * i, type_to_link[i]);
    }
    put(file, kSections + 40 * number + 36, 0);
}

void put_symbol(Bytes& file, std::size_t number, std::uint32_t name, std::uint32_t address, std::uint32_t size,
                std::uint32_t type) {
    std::size_t const at = kSymbols + 16 * number;
    put(file, at, name);
    put(file, at + 4, address);
    put(file, at + 8, size);
    put(file, at + 12, type);
}

/// Four instructions at 0x100, `main` with two of them, `user_step` with two; then 16 bytes of `mydata`.
Bytes elf() {
    Bytes file;
    put(file, 0, 0x464c457f);
    put(file, 4, 0x00010101);  // 32 bits, little-endian
    put(file, 16, 2, 2);       // executable
    put(file, 18, 243, 2);     // RISC-V
    put(file, 20, 1);
    put(file, 24, kCodeAt);
    put(file, 28, kSegment);
    put(file, 32, kSections);
    put(file, 36, 0);
    put(file, 42, 32, 2);
    put(file, 44, 1, 2);
    put(file, 46, 40, 2);
    put(file, 48, 4, 2);
    std::array<std::uint32_t, 6> const segment{1, kCode, 0xdead0000, kCodeAt, 16, 32};
    for (std::size_t i = 0; i < segment.size(); ++i) {
        put(file, kSegment + 4 * i, segment[i]);
    }
    put_section(file, 0, {0, 0, 0, 0, 0, 0});
    put_section(file, 1, {1, 0x6, kCodeAt, kCode, 16, 0});
    put_section(file, 2, {2, 0, 0, kSymbols, 4 * 16, 3});
    put_section(file, 3, {3, 0, 0, kNames, static_cast<std::uint32_t>(kTexts.size()), 0});
    for (std::size_t i = 0; i < 4; ++i) {
        put(file, kCode + 4 * i, kNoOperation);
    }
    put_symbol(file, 0, 0, 0, 0, 0);
    put_symbol(file, 1, 6, kCodeAt + 8, 8, 2);
    put_symbol(file, 2, 1, kCodeAt, 8, 2);
    put_symbol(file, 3, 16, kCodeAt + 16, 16, 1);
    file.resize(kNames + kTexts.size());
    std::memcpy(&file[kNames], kTexts.data(), kTexts.size());
    return file;
}

std::string refusal(Bytes const& file, FirmwareMemory const& memory = {}) {
    try {
        read_firmware("robot.elf", file, memory);
        return "";
    } catch (ConfigError const& error) {
        return error.what();
    }
}

Bytes changed(std::size_t at, std::uint32_t value, std::size_t size = 4) {
    Bytes file = elf();
    put(file, at, value, size);
    return file;
}

TEST(FirmwareFile, IsInMemoryAtItsPhysicalAddresses) {
    Firmware const firmware = read_firmware("robot.elf", elf());
    EXPECT_EQ(firmware.entry, kCodeAt);
    ASSERT_EQ(firmware.image->bytes.size(), kMemoryBytes);
    EXPECT_EQ(read_little_endian<4>(&firmware.image->bytes[kCodeAt + 12]), kNoOperation);
    EXPECT_TRUE(std::all_of(firmware.image->bytes.begin() + kCodeAt + 16, firmware.image->bytes.end(),
                            [](std::byte byte) { return byte == std::byte{0}; }));
    EXPECT_EQ(firmware.code.address, kCodeAt);
    EXPECT_EQ(firmware.code.bytes(), 16U);
}

/// The same in flash, from where its variables are copied to memory.
Bytes elf_in_flash() {
    Bytes file = elf();
    put(file, 24, kFlashAddress + kCodeAt);
    put(file, kSegment + 8, 0x40);
    put(file, kSegment + 12, kFlashAddress + kCodeAt);
    put(file, kSections + 40 + 12, kFlashAddress + kCodeAt);
    return file;
}

TEST(FirmwareFile, MayBeInFlash) {
    Firmware const firmware = read_firmware("robot.elf", elf_in_flash());
    EXPECT_EQ(firmware.entry, kFlashAddress + kCodeAt);
    EXPECT_EQ(firmware.code.address, kFlashAddress + kCodeAt);
    EXPECT_EQ(firmware.code.bytes(), 16U);
    ASSERT_EQ(firmware.image->flash.size(), kCodeAt + 16);
    EXPECT_EQ(firmware.image->flash[0], std::byte{0xff});
    EXPECT_TRUE(std::ranges::all_of(firmware.image->bytes, [](std::byte byte) { return byte == std::byte{0}; }));
    Core core{.x = {}, .pc = firmware.entry, .cycles = 0};
    Memory memory(firmware.image);
    EXPECT_EQ(run(core, memory, firmware.code, 3 + CycleCosts().cache_miss).pc, firmware.entry + 12);
}

TEST(FirmwareFile, InFlashMustFitThereAndItsVariablesIntoMemory) {
    EXPECT_NE(refusal(elf_in_flash(), {.flash_bytes = kCodeAt + 15}), "");
    EXPECT_EQ(refusal(elf_in_flash(), {.flash_bytes = kCodeAt + 16}), "");
    Bytes file = elf_in_flash();
    put(file, kSegment + 8, kMemoryBytes - 31);
    EXPECT_NE(refusal(file).find("does not fit into the robot's memory"), std::string::npos) << refusal(file);
    file = elf_in_flash();
    put(file, kSections + 40 + 12, kCodeAt);  // not where the segment is
    put(file, 24, kCodeAt);
    EXPECT_EQ(refusal(file), "");  // its memory is zero, which is no instruction: it stops there
}

TEST(FirmwareFile, FindsFunctionsByNameAndByAddress) {
    Firmware const firmware = read_firmware("robot.elf", elf());
    ASSERT_NE(firmware.find("user_step"), nullptr);
    EXPECT_EQ(firmware.find("user_step")->address, kCodeAt + 8);
    ASSERT_NE(firmware.find("mydata"), nullptr);
    EXPECT_FALSE(firmware.find("mydata")->is_function);
    EXPECT_EQ(firmware.find("mydata")->bytes, 16U);
    EXPECT_EQ(firmware.find("absent"), nullptr);
    auto const name_at = [&](std::uint32_t address) {
        FirmwareSymbol const* const found = firmware.function_at(address);
        return found == nullptr ? "" : found->name;
    };
    EXPECT_EQ(name_at(kCodeAt), "main");
    EXPECT_EQ(name_at(kCodeAt + 4), "main");
    EXPECT_EQ(name_at(kCodeAt + 8), "user_step");
    EXPECT_EQ(name_at(kCodeAt + 15), "user_step");
    EXPECT_EQ(name_at(kCodeAt + 16), "");  // a variable
    EXPECT_EQ(name_at(0), "");
}

TEST(FirmwareFile, RunsUntilTheEndOfItsCode) {
    Firmware const firmware = read_firmware("robot.elf", elf());
    Core core{.x = {}, .pc = firmware.entry, .cycles = 0};
    Memory memory(firmware.image);
    Stop const stop = run(core, memory, firmware.code, 100);
    EXPECT_EQ(stop.reason, StopReason::jump_outside);
    EXPECT_EQ(stop.pc, kCodeAt + 16);
}

TEST(FirmwareFile, EachWrongKindOfFileIsToldApart) {
    constexpr auto how = "compile with -march=rv32im -mabi=ilp32"sv;
    auto const expect = [](Bytes const& file, std::string_view text) {
        std::string const said = refusal(file);
        EXPECT_TRUE(said.starts_with("robot.elf: ")) << said;
        EXPECT_NE(said.find(text), std::string::npos) << said << "\n expected: " << text;
        EXPECT_EQ(std::ranges::count(said, '\n'), 0);
    };
    expect({}, "is no firmware");
    expect(Bytes(100, std::byte{'#'}), "is no firmware");
    expect(changed(4, 2, 1), "64 bits");
    expect(changed(4, 2, 1), how);
    expect(changed(5, 2, 1), "another processor");
    expect(changed(18, 62, 2), "another processor");
    expect(changed(16, 1, 2), "not linked");
    expect(changed(16, 3, 2), "not linked");
    expect(changed(36, 1), "compressed instructions");
    expect(changed(36, 2), "floating-point registers");
    expect(changed(24, 0x50), "starts at 0x00000050");
    expect(changed(kSegment + 12, kMemoryBytes - 16), "does not fit into the robot's memory");
    expect(changed(kSegment + 20, 0xffffffff), "does not fit into the robot's memory");
    expect(changed(kSections + 2 * 40 + 4, 0), "has no symbols");
    expect(changed(kSections + 2 * 40 + 24, 9), "is damaged");
    expect(changed(42, 31, 2), "is damaged");
    expect(changed(kSections + 40 + 8, 0), "no section of code");
    expect(changed(kSections + 40 + 12, kCodeAt + 2), "no multiple of 4");
}

TEST(FirmwareFile, FitsIntoTheMemoryOfTheModelOrNot) {
    EXPECT_EQ(refusal(elf(), {.address = 0, .bytes = kCodeAt + 32}), "");
    EXPECT_NE(refusal(elf(), {.address = 0, .bytes = kCodeAt + 28}), "");
    EXPECT_EQ(refusal(elf(), {.address = kCodeAt, .bytes = 32}), "");
    EXPECT_NE(refusal(elf(), {.address = kCodeAt + 4, .bytes = 1024}), "");
}

TEST(FirmwareFile, IsRefusedWhereverItIsCutOff) {
    Bytes const whole = elf();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        EXPECT_NE(refusal(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))), "") << size;
    }
}

TEST(FirmwareFile, RandomChangesNeverDoMoreThanToBeRefusedOrRead) {
    RandomStream random(5, 5);
    int read = 0;
    for (int i = 0; i < 20'000; ++i) {
        Bytes file = elf();
        for (std::uint32_t k = 1 + random.below(4); k > 0; --k) {
            file[random.below(static_cast<std::uint32_t>(file.size()))] = static_cast<std::byte>(random.bits());
        }
        read += refusal(file).empty() ? 1 : 0;
    }
    EXPECT_GT(read, 1000);
}

}  // namespace
}  // namespace pogosim
