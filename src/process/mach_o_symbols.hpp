// What program_symbols.hpp reads, from files of macOS. These have no sizes of symbols: a variable, or a function, is
// taken to reach to the next one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "process/mach_o_file.hpp"
#include "process/program_symbols.hpp"

namespace pogosim {

ProgramSymbols mach_o_symbols(MachOFile const& file);
std::vector<ProgramFunction> mach_o_functions(MachOFile const& file);
std::string mach_o_function_at(MachOFile const& file, std::uintptr_t address);
std::vector<std::string> mach_o_texts(MachOFile const& file, std::string_view part_of_name);

/// The names of variables that the system makes one for all copies of a program in a process: those of inline functions
/// and templates in C++.
std::vector<std::string> mach_o_variables_of_all_copies(MachOFile const& file);

}  // namespace pogosim
