// A user's program in memory: linked into the executable that runs, or loaded from a shared object.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pogosim/program.h"
#include "process/constructors.hpp"
#include "process/own_executable.hpp"
#include "process/program_symbols.hpp"

namespace pogosim {

struct ProgramImage {
    std::string name;                               // that its main() is told
    std::vector<std::span<std::byte>> variables{};  // memory that it can write: its .data and .bss
    int (*main)() = nullptr;
    std::size_t user_data_bytes = 0;
    void (*construct_user_data)(void*) = nullptr;  // null in C
    void** plain_mydata = nullptr;  // its `mydata`, if it has one that is not of the library; null: it has none
    std::shared_ptr<Constructors const> constructors{};      // of its static objects; null: there are none
    bool is_for_sdk = false;                                 // its main() does not return
    std::shared_ptr<void> loaded{};                          // keeps a loaded program in memory; null: it is linked in
    std::uintptr_t load_address = 0;                         // of what its file says
    std::filesystem::path file = own_executable();           // that it was read from
    std::filesystem::file_time_type file_time{};             // when it was written; none: it is the one that runs
    std::shared_ptr<ProgramSymbols const> loaded_symbols{};  // of a loaded program

    /// The bytes of the file; empty if it has changed or gone since.
    std::vector<char> bytes_of_file() const;

    /// What its file says.
    ProgramSymbols symbols() const;

    /// The functions that its file names; none if it has changed since.
    std::vector<ProgramFunction> functions() const;

    /// The variables of which each robot may have its own, see ProgramSymbols::memory.
    std::vector<std::span<std::byte>> memory_of_robots() const;
};

/// Whether a place is in one of these pieces of memory.
inline bool is_in_any(std::span<std::span<std::byte> const> pieces, void const* place) {
    return std::ranges::any_of(
        pieces, [place](auto const& piece) { return place >= piece.data() && place < piece.data() + piece.size(); });
}

/// Whether a program was built with this minor version; the interface of another one may be another. Executables must
/// be asked, too: where the name of their library has no version, as in the Python package, it can be exchanged.
bool has_this_interface(pogosim_program const& program);

/// Throws ConfigError for a program of another minor version. `file`: what the message calls it.
void require_this_interface(pogosim_program const& program, std::filesystem::path const& file);

/// A program that is a part of this executable, and was built with this minor version.
ProgramImage linked_program(pogosim_program const& program, std::string name);

/// Loads a program from a shared object, such as `make sim` makes beside an executable. Each call loads a copy with
/// variables of its own, as the file is now: the file may be built again in the meantime. Throws ConfigError if the
/// file is missing, is no shared object, no program for Pogosim, or one for another version of it.
ProgramImage load_program(std::filesystem::path const& file);

}  // namespace pogosim
