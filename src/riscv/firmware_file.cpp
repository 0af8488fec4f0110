#include "riscv/firmware_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/error.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kHowToCompile = "compile with -march=rv32im -mabi=ilp32";

// Fields of the file's header, and what they must be.
constexpr std::size_t kHeaderBytes = 52;
constexpr unsigned kClassOf32Bits = 1;
constexpr unsigned kLittleEndian = 1;
constexpr std::uint32_t kExecutable = 2;
constexpr std::uint32_t kRiscV = 243;
constexpr std::uint32_t kCompressed = 0x1;     // of its flags
constexpr std::uint32_t kFloatingPoint = 0x6;  // arguments in floating-point registers

constexpr std::uint32_t kLoaded = 1;          // type of a segment
constexpr std::uint32_t kSymbolTable = 2;     // type of a section
constexpr std::uint32_t kWritable = 0x1;      // flag of a section
constexpr std::uint32_t kInMemory = 0x2;      // flag of a section
constexpr std::uint32_t kInstructions = 0x4;  // flag of a section
constexpr unsigned kFunction = 2;             // type of a symbol; below it, variables and names without a type

struct Segment {
    std::uint32_t type;
    std::uint32_t offset;
    std::uint32_t address;  // where the program uses it
    std::uint32_t physical_address;
    std::uint32_t file_bytes;
    std::uint32_t memory_bytes;
};

struct Section {
    std::uint32_t type;
    std::uint32_t flags;
    std::uint32_t address;
    std::uint32_t offset;
    std::uint32_t bytes;
    std::uint32_t link;  // of a table of symbols: the section of their names
};

class FirmwareFile {
public:
    FirmwareFile(std::string_view name, std::span<std::byte const> bytes, FirmwareMemory const& memory)
        : name_(name), bytes_(bytes), memory_(memory) {}

    Firmware read(CycleCosts const& costs) const {
        check_header();
        Firmware firmware;
        firmware.image = std::make_shared<MemoryImage const>(image());
        firmware.variables_end = end_of_variables();
        std::vector<Section> const sections = all_sections();
        auto const [begin, end] = range_of_code(sections);
        firmware.code = decode_code(begin, code(*firmware.image, begin, end), costs);
        firmware.entry = number<4>(0, 24);
        if (firmware.entry < begin || firmware.entry >= end) {
            fail(fmt::format("starts at 0x{:08x}, where it has no code", firmware.entry));
        }
        for (Section const& section : sections) {
            if ((section.flags & kInMemory) != 0) {
                std::uint32_t& bytes =
                    (section.flags & kWritable) != 0 ? firmware.variable_bytes : firmware.program_bytes;
                bytes += section.bytes;
            }
        }
        firmware.symbols = symbols(sections);
        return firmware;
    }

private:
    [[noreturn]] void fail(std::string const& what) const { throw ConfigError(fmt::format("{}: {}", name_, what)); }

    /// A part of the file.
    std::span<std::byte const> part(std::uint64_t offset, std::uint64_t size, char const* what) const {
        if (offset > bytes_.size() || size > bytes_.size() - offset) {
            fail(fmt::format("is cut off: it has {} bytes, and {} should end at {}", bytes_.size(), what,
                             offset + size));
        }
        return bytes_.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
    }

    template <std::uint32_t Bytes>
    std::uint32_t number(std::uint64_t begin, std::uint32_t offset) const {
        return read_little_endian<Bytes>(part(begin + offset, Bytes, "a header").data());
    }

    void check_header() const {
        constexpr std::string_view magic = "\177ELF";
        std::string_view const text(reinterpret_cast<char const*>(bytes_.data()), bytes_.size());
        if (!text.starts_with(magic)) {
            fail("is no firmware: expected an ELF file, as the robots' compiler makes it");
        }
        part(0, kHeaderBytes, "its header");
        if (number<1>(0, 4) != kClassOf32Bits) {
            fail(fmt::format("is a program of 64 bits, not for a robot, whose processor has 32: {}", kHowToCompile));
        }
        if (number<1>(0, 5) != kLittleEndian || number<2>(0, 18) != kRiscV) {
            fail(fmt::format("is a program for another processor; robots have a RISC-V processor: {}", kHowToCompile));
        }
        if (number<2>(0, 16) != kExecutable) {
            fail("is not linked: expected an executable, not an object file or a library");
        }
        std::uint32_t const flags = number<4>(0, 36);
        if ((flags & kCompressed) != 0) {
            fail(fmt::format("has compressed instructions, which robots do not have: {}", kHowToCompile));
        }
        if ((flags & kFloatingPoint) != 0) {
            fail(fmt::format("uses floating-point registers, which robots do not have: {}", kHowToCompile));
        }
    }

    /// Headers of a table, whose offset, size of an entry, and length are at these places of the file's header.
    template <class Header, class Read>
    std::vector<Header> table(std::uint32_t offset_at, std::uint32_t size_at, std::uint32_t least_bytes,
                              Read const& read) const {
        std::uint64_t const offset = number<4>(0, offset_at);
        std::uint32_t const size = number<2>(0, size_at);
        std::uint32_t const count = number<2>(0, size_at + 2);
        if (count > 0 && size < least_bytes) {
            fail(fmt::format("is damaged: its headers have {} bytes each, and need {}", size, least_bytes));
        }
        std::vector<Header> headers;
        for (std::uint32_t i = 0; i < count; ++i) {
            part(offset + std::uint64_t{i} * size, least_bytes, "a header");
            headers.push_back(read(offset + std::uint64_t{i} * size));
        }
        return headers;
    }

    std::vector<Segment> all_segments() const {
        return table<Segment>(28, 42, 32, [this](std::uint64_t at) {
            return Segment{.type = number<4>(at, 0),
                           .offset = number<4>(at, 4),
                           .address = number<4>(at, 8),
                           .physical_address = number<4>(at, 12),
                           .file_bytes = number<4>(at, 16),
                           .memory_bytes = number<4>(at, 20)};
        });
    }

    std::vector<Section> all_sections() const {
        return table<Section>(32, 46, 40, [this](std::uint64_t at) {
            return Section{.type = number<4>(at, 4),
                           .flags = number<4>(at, 8),
                           .address = number<4>(at, 12),
                           .offset = number<4>(at, 16),
                           .bytes = number<4>(at, 20),
                           .link = number<4>(at, 24)};
        });
    }

    bool is_in_memory(std::uint32_t address, std::uint32_t size) const {
        return address >= memory_.address &&
               std::uint64_t{address} + size <= std::uint64_t{memory_.address} + memory_.bytes;
    }

    bool is_in_flash(std::uint32_t address, std::uint32_t size) const {
        return address >= memory_.flash_address &&
               std::uint64_t{address} + size <= std::uint64_t{memory_.flash_address} + memory_.flash_bytes;
    }

    std::string text_of_memory() const {
        return fmt::format("memory is from 0x{:08x} to 0x{:08x}, flash from 0x{:08x} to 0x{:08x}", memory_.address,
                           std::uint64_t{memory_.address} + memory_.bytes - 1, memory_.flash_address,
                           std::uint64_t{memory_.flash_address} + memory_.flash_bytes - 1);
    }

    MemoryImage image() const {
        MemoryImage image{.address = memory_.address,
                          .bytes = std::vector<std::byte>(memory_.bytes),
                          .flash_address = memory_.flash_address,
                          .flash = {}};
        for (Segment const& segment : all_segments()) {
            if (segment.type == kLoaded && segment.memory_bytes > 0) {
                place(segment, image);
            }
        }
        return image;
    }

    std::uint32_t end_of_variables() const {
        std::uint32_t end = memory_.address;
        for (Segment const& segment : all_segments()) {
            if (segment.type == kLoaded && is_in_memory(segment.address, segment.memory_bytes)) {
                end = std::max(end, segment.address + segment.memory_bytes);
            }
        }
        return end;
    }

    void check_is_in_memory(std::uint32_t address, std::uint32_t size) const {
        if (!is_in_memory(address, size)) {
            fail(fmt::format("does not fit into the robot's memory: it has {} bytes at 0x{:08x}, and {}", size, address,
                             text_of_memory()));
        }
    }

    void place(Segment const& segment, MemoryImage& image) const {
        std::span const bytes = part(segment.offset, segment.file_bytes, "a segment");
        std::uint32_t const at = segment.physical_address;
        if (is_in_flash(at, segment.file_bytes) && segment.file_bytes > 0) {
            if (!is_in_flash(segment.address, segment.memory_bytes)) {
                check_is_in_memory(segment.address, segment.memory_bytes);  // its start code copies it there
            }
            std::size_t const offset = at - memory_.flash_address;
            std::size_t const end = offset + segment.file_bytes;
            image.flash.resize(std::max(image.flash.size(), (end + 3) / 4 * 4), std::byte{0xff});
            std::ranges::copy(bytes, image.flash.begin() + static_cast<std::ptrdiff_t>(offset));
            return;
        }
        std::uint32_t const size = std::max(segment.file_bytes, segment.memory_bytes);
        // Memory that is only reserved is where the program uses it.
        std::uint32_t const used_at = segment.file_bytes > 0 ? at : segment.address;
        check_is_in_memory(used_at, size);
        std::ranges::copy(bytes, image.bytes.begin() + (used_at - memory_.address));
    }

    /// What is in memory or flash where the code is.
    std::span<std::byte const> code(MemoryImage const& image, std::uint32_t begin, std::uint32_t end) const {
        bool const is_memory = is_in_memory(begin, end - begin);
        std::span const bytes(is_memory ? image.bytes : image.flash);
        std::uint32_t const offset = begin - (is_memory ? image.address : image.flash_address);
        if (std::uint64_t{offset} + (end - begin) > bytes.size()) {
            fail(fmt::format("has no instructions at 0x{:08x}, where its code should be", begin));
        }
        return bytes.subspan(offset, end - begin);
    }

    struct Range {
        std::uint32_t begin;
        std::uint32_t end;
    };
    Range range_of_code(std::vector<Section> const& sections) const {
        Range range{.begin = std::numeric_limits<std::uint32_t>::max(), .end = 0};
        for (Section const& section : sections) {
            constexpr std::uint32_t both = kInMemory | kInstructions;
            if ((section.flags & both) != both || section.bytes == 0) {
                continue;
            }
            if (!is_in_memory(section.address, section.bytes) && !is_in_flash(section.address, section.bytes)) {
                fail(fmt::format("has code outside of the robot's memory: {} bytes at 0x{:08x}; {}", section.bytes,
                                 section.address, text_of_memory()));
            }
            range.begin = std::min(range.begin, section.address);
            range.end = std::max(range.end, section.address + section.bytes);
        }
        if (range.end == 0) {
            fail("has no section of code: was it stripped?");
        }
        if (is_in_memory(range.begin, 1) != is_in_memory(range.end - 1, 1)) {
            fail("has code in memory and in flash: only one of them can be simulated");
        }
        if (range.begin % 4 != 0) {
            fail(fmt::format("has code at 0x{:08x}, which is no multiple of 4", range.begin));
        }
        return range;
    }

    std::vector<FirmwareSymbol> symbols(std::vector<Section> const& sections) const {
        auto const found = std::ranges::find(sections, kSymbolTable, &Section::type);
        if (found == sections.end()) {
            fail("has no symbols: functions of the robot's library cannot be found; do not strip it (-s)");
        }
        if (found->link >= sections.size()) {
            fail("is damaged: its symbols have no names");
        }
        Section const& strings = sections[found->link];
        std::span const table = part(found->offset, found->bytes, "the table of symbols");
        std::span const names = part(strings.offset, strings.bytes, "the names of symbols");
        constexpr std::size_t entry_bytes = 16;
        std::vector<FirmwareSymbol> symbols;
        for (std::size_t at = 0; at + entry_bytes <= table.size(); at += entry_bytes) {
            std::byte const* const entry = &table[at];
            unsigned const type = read_little_endian<1>(entry + 12) & 0xFU;
            std::string name = name_at(names, read_little_endian<4>(entry));
            // Those of a linker script and of assembler have no type.
            if (type <= kFunction && !name.empty()) {
                symbols.push_back({.address = read_little_endian<4>(entry + 4),
                                   .bytes = read_little_endian<4>(entry + 8),
                                   .is_function = type == kFunction,
                                   .is_global = read_little_endian<1>(entry + 12) >> 4 != 0,
                                   .name = std::move(name)});
            }
        }
        std::ranges::stable_sort(symbols, {}, &FirmwareSymbol::address);
        return symbols;
    }

    static std::string name_at(std::span<std::byte const> names, std::uint32_t offset) {
        std::span const rest = names.subspan(std::min<std::size_t>(offset, names.size()));
        auto const end = std::ranges::find(rest, std::byte{0});
        return end == rest.end() ? std::string()
                                 : std::string(reinterpret_cast<char const*>(rest.data()), end - rest.begin());
    }

    std::string_view name_;
    std::span<std::byte const> bytes_;
    FirmwareMemory memory_;
};

}  // namespace

FirmwareSymbol const* Firmware::find(std::string_view name) const {
    auto const found = std::ranges::find(symbols, name, &FirmwareSymbol::name);
    return found == symbols.end() ? nullptr : &*found;
}

FirmwareSymbol const* Firmware::function_at(std::uint32_t address) const {
    FirmwareSymbol const* found = nullptr;
    for (FirmwareSymbol const& symbol : symbols) {
        bool const is_in = address == symbol.address || address - symbol.address < symbol.bytes;
        if (symbol.address > address) {
            break;
        }
        found = symbol.is_function && is_in ? &symbol : found;
    }
    return found;
}

Firmware read_firmware(std::string_view file, std::span<std::byte const> bytes, FirmwareMemory const& memory,
                       CycleCosts const& costs) {
    return FirmwareFile(file, bytes, memory).read(costs);
}

}  // namespace pogosim
