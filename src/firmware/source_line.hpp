// Where the code of a firmware is in its source, by the DWARF information of its file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace pogosim {

/// "main.c:84" for an address in the code of an ELF file with these bytes; empty: the file does not say, or this
/// Pogosim was built without libdw.
std::string source_line(std::span<std::byte const> elf_file, std::uint32_t address);

}  // namespace pogosim
