// The parts of a program's file on macOS (Mach-O, 64 bits, as <mach-o/loader.h> and <mach-o/nlist.h> describe it). The
// file need not be well-formed: parts that lie beyond its end count as missing. A file for several processors (a
// "universal" one) is read as the file in it for one of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pogosim {

enum class MachOProcessor : std::uint32_t { x86_64 = 0x01000007, arm64 = 0x0100000c };

/// The one that this code is compiled for.
#ifdef __aarch64__
inline constexpr MachOProcessor kOwnProcessor = MachOProcessor::arm64;
#else
inline constexpr MachOProcessor kOwnProcessor = MachOProcessor::x86_64;
#endif

struct MachOSegment {
    std::string_view name;
    std::uint64_t address = 0;  // of which the file says; the system loads it elsewhere
    std::uint64_t memory_bytes = 0;
    std::uint64_t offset = 0;  // in the file
    std::uint64_t file_bytes = 0;
    bool is_writable = false;  // also after the start: not __DATA_CONST
};

struct MachOSection {
    std::string_view segment;
    std::string_view name;
    std::uint64_t address = 0;
    std::uint64_t bytes = 0;
    std::uint32_t offset = 0;  // in the file
    std::uint8_t type = 0;     // kZeroFill, ...
    bool is_code = false;
    bool is_writable = false;

    static constexpr std::uint8_t kRegular = 0x0;
    static constexpr std::uint8_t kZeroFill = 0x1;
    static constexpr std::uint8_t kInitializers = 0x9;  // addresses of functions
    static constexpr std::uint8_t kFinalizers = 0xa;    // the same
    static constexpr std::uint8_t kCoalesced = 0xb;     // of which the linker keeps one
    static constexpr std::uint8_t kLargeZeroFill = 0xc;
    static constexpr std::uint8_t kThreadRegular = 0x11;       // what variables of threads are in the beginning
    static constexpr std::uint8_t kThreadZeroFill = 0x12;      // the same
    static constexpr std::uint8_t kThreadVariables = 0x13;     // a descriptor for each
    static constexpr std::uint8_t kInitializerOffsets = 0x16;  // 32 bits each, from the beginning of the file

    bool is_zero_filled() const { return type == kZeroFill || type == kLargeZeroFill || type == kThreadZeroFill; }
};

struct MachOSymbol {
    std::string_view name;      // without the underscore before names of C
    std::uint8_t section = 0;   // counted from 1 on; 0: it is in none
    std::uint64_t address = 0;  // of which the file says
    bool is_defined = false;
    bool is_external = false;  // other files see it
    bool is_weak = false;      // defined in several files, of which the system takes one
    std::string_view library;  // that an undefined one is looked for in; empty: any
};

struct MachOFile {
    std::span<char const> bytes{};  // of the one for the processor
    bool is_known = false;          // false: it is no such file, or for another processor
    bool is_for_other_processor = false;
    std::uint32_t type = 0;
    std::vector<MachOSegment> segments{};
    std::vector<MachOSection> sections{};
    std::vector<std::string_view> libraries{};
    std::string build{};             // 32 hexadecimal digits (LC_UUID); empty: it has none
    std::uint64_t address = 0;       // of its beginning, of which the file says
    std::uint32_t symbol_table = 0;  // its offset
    std::uint32_t symbol_count = 0;
    std::span<char const> names{};

    static constexpr std::uint32_t kExecutable = 0x2;
    static constexpr std::uint32_t kLibrary = 0x6;
    static constexpr std::uint32_t kBundle = 0x8;

    /// The bytes of a section; none if the file has no room for them.
    std::span<char const> content(MachOSection const& section) const;

    /// The symbols, but for those of debuggers.
    std::vector<MachOSymbol> symbols() const;
};

MachOFile mach_o_file(std::span<char const> bytes, MachOProcessor processor = kOwnProcessor);

/// The same of a file that is in memory: its header and what is behind it, as the system has loaded them.
MachOFile mach_o_in_memory(void const* header);

/// The reason why a file cannot be loaded as a program; empty: there is none.
std::string problem_of_mach_o(MachOFile const& file);

}  // namespace pogosim
