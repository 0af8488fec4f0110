// The variables of a program and the functions that it calls, by the symbol table of its file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pogosim {

struct ProgramSymbols {
    /// One that the program may change.
    struct Variable {
        std::string name;
        std::uintptr_t address = 0;  // from where the program is loaded
        std::size_t bytes = 0;
        bool is_of_thread = false;  // each thread has its own
    };

    /// A piece of memory.
    struct Piece {
        std::uintptr_t begin = 0;  // from where the program is loaded
        std::uintptr_t end = 0;
    };

    bool are_known = false;  // false: it has no symbol table (strip, -s), or this system has other files
    std::vector<Variable> variables{};
    std::vector<Piece> memory{};  // of which robots may have their own: not POGO_SHARED, nor what is of libraries
    std::vector<std::string> imports{};  // names of functions and variables of libraries
    std::size_t bytes_of_threads = 0;    // of all variables of threads, also those without a symbol (-Wl,-x)
    bool has_static = false;             // static variables and functions are among them: not with -Wl,-x, strip -x
    std::string allocating_format{};     // a text like "%ms", with which sscanf() allocates; empty: there is none

    /// Whether a C++ object with this symbol is initialised at most once, when the program gets there for the first
    /// time.
    bool has_guard(std::string const& symbol) const;
};

/// "steps" for the symbol "steps.0" of a variable in a function (gcc), "user_step::steps" for "user_step.steps"
/// (clang), "name()::n" for "_ZZ4namevE1n" (C++).
std::string name_by_symbol(std::string const& symbol);

/// The first conversion of sscanf() that allocates a text: "%ms", "%2$16mc", "%m[", or "%as" of old C; empty: none.
std::string allocating_conversion(std::string_view bytes);

/// `file`: the bytes of an executable or a shared object, which need not be well-formed.
ProgramSymbols symbols_of(std::span<char const> file);

/// A function of a program.
struct ProgramFunction {
    std::string symbol;          // of the linker: in C++, with the types of its parameters
    std::uintptr_t address = 0;  // from where the program is loaded

    /// As the program writes it: "user_step", also for "user_step()" in C++.
    std::string name() const;
};
std::vector<ProgramFunction> functions_of(std::span<char const> file);

/// The function with this address, from where the program is loaded, as the linker knows it; empty: there is none.
std::string function_at(std::span<char const> file, std::uintptr_t address);

/// The texts that are in constants whose symbols have these words in their names.
std::vector<std::string> texts_of(std::span<char const> file, std::string_view part_of_name);

}  // namespace pogosim
