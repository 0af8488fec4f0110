// A firmware: the ELF file that the robots' compiler has made of a program, ready to run on their processor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "riscv/code.hpp"
#include "riscv/memory_image.hpp"

namespace pogosim {

/// A function or a variable of a firmware.
struct FirmwareSymbol {
    std::uint32_t address = 0;
    std::uint32_t bytes = 0;  // 0: the file does not say
    bool is_function = false;
    bool is_global = false;  // else of one file
    std::string name;
};

struct Firmware {
    std::shared_ptr<MemoryImage const> image;  // as it is when a robot starts
    Code code;                                 // of its executable sections
    std::uint32_t entry = 0;                   // where it starts
    std::uint32_t variables_end = 0;           // in memory: what it does not reserve begins there
    std::uint32_t program_bytes = 0;           // of code and constants
    std::uint32_t variable_bytes = 0;
    std::vector<FirmwareSymbol> symbols;  // ascending by address

    /// Null: there is none. If several have the name, it is the first one.
    FirmwareSymbol const* find(std::string_view name) const;

    /// The function at an address; null: none is known there.
    FirmwareSymbol const* function_at(std::uint32_t address) const;
};

/// Where a robot's memory is, and its flash, from which programs may also run.
struct FirmwareMemory {
    std::uint32_t address = 0;
    std::uint32_t bytes = kMemoryBytes;
    std::uint32_t flash_address = kFlashAddress;
    std::uint32_t flash_bytes = kFlashBytes;
};

/// Reads a firmware out of the bytes of its file. As when a firmware is uploaded, its parts are at their physical
/// addresses (those of `objcopy -O binary`), in memory or in flash, and the rest of the memory is zero. Its code is
/// either all in memory, or all in flash.
///
/// Throws ConfigError that begins with `file`, the name of the file in messages, for what is no ELF file of 32 bits,
/// little-endian, for RISC-V, executable, without compressed instructions and floating-point registers; is cut off; has
/// no symbols; or does not fit into the memory.
///
/// Sources: Tool Interface Standard, Executable and Linking Format Specification, version 1.2 (1995); RISC-V ELF psABI
/// Specification, version 1.0 (2022), chapter "ELF Object Files".
Firmware read_firmware(std::string_view file, std::span<std::byte const> bytes, FirmwareMemory const& memory = {},
                       CycleCosts const& costs = {});

}  // namespace pogosim
