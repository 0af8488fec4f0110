// What program_symbols.hpp reads, from files of macOS. These have no sizes of symbols: a variable, or a function, is
// taken to reach to the next one.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "process/mach_o_file.hpp"
#include "process/program_symbols.hpp"

namespace pogosim {

ProgramSymbols mach_o_symbols(std::span<char const> file, MachOProcessor processor = kOwnProcessor);
std::vector<ProgramFunction> mach_o_functions(std::span<char const> file, MachOProcessor processor = kOwnProcessor);
std::string mach_o_function_at(std::span<char const> file, std::uintptr_t address,
                               MachOProcessor processor = kOwnProcessor);
std::vector<std::string> mach_o_texts(std::span<char const> file, std::string_view part_of_name,
                                      MachOProcessor processor = kOwnProcessor);

/// The names of variables that the system makes one for all copies of a program in a process: those of inline functions
/// and templates in C++.
std::vector<std::string> mach_o_variables_of_all_copies(std::span<char const> file,
                                                        MachOProcessor processor = kOwnProcessor);

}  // namespace pogosim
