// A linked program as a file (ELF): its sections, its symbols, and where its debug information begins.
#pragma once

#include <elfutils/libdw.h>

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>

#include "debug_info/entries.hpp"

namespace shared_state {

/// A problem with the file, for the user.
struct ProgramError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class ProgramFile {
public:
    /// Throws ProgramError if the file is not a linked program with debug information.
    explicit ProgramFile(std::string const& path);

    Dwarf* debug_info() const { return file_.debug_info(); }

    struct Section {
        std::string name;
        bool writable = false;  ///< while the program runs: not what only the loader writes or reads
    };
    /// The section that holds this address; an unnamed one if none does.
    Section section_at(uint64_t address) const;

    /// The text that ends with a zero byte at this address; empty if there is none in the file.
    std::string text_at(uint64_t address) const;

    /// Name of the object at this address, as the linker knows it; empty if there is none.
    std::string symbol_at(uint64_t address) const;

    /// Whether it is written for the robots' SDK alone (pogobot.h): each simulated robot has its own variables.
    bool is_for_sdk() const;

    /// Whether a guard makes sure that the C++ object with this symbol is initialised at most once: it is initialised
    /// when the first robot gets there.
    bool has_guard(std::string const& symbol) const;

private:
    void read_symbols();

    DebugFile file_;
    Elf* elf_ = nullptr;
    std::multimap<uint64_t, std::string> symbols_;
    std::map<std::string, uint64_t> guards_;
};

}  // namespace shared_state
