#include "process/mach_o_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

namespace pogosim {

namespace {

static_assert(std::endian::native == std::endian::little, "as are the files, but for the header of universal ones");

constexpr std::uint32_t kMagic = 0xfeedfacf;
constexpr std::uint32_t kUniversalMagic = 0xcafebabe;

struct Header {
    std::uint32_t magic;
    std::uint32_t processor;
    std::uint32_t processor_kind;
    std::uint32_t type;
    std::uint32_t command_count;
    std::uint32_t command_bytes;
    std::uint32_t flags;
    std::uint32_t reserved;
};

struct Command {
    std::uint32_t kind;
    std::uint32_t bytes;
};

constexpr std::uint32_t kSegment = 0x19;
struct SegmentCommand {
    Command command;
    char name[16];
    std::uint64_t address;
    std::uint64_t memory_bytes;
    std::uint64_t offset;
    std::uint64_t file_bytes;
    std::int32_t most_protection;
    std::int32_t protection;
    std::uint32_t section_count;
    std::uint32_t flags;
};
constexpr std::int32_t kCanBeWritten = 0x2;
constexpr std::uint32_t kReadOnlyAfterStart = 0x10;

struct SectionOfSegment {
    char name[16];
    char segment[16];
    std::uint64_t address;
    std::uint64_t bytes;
    std::uint32_t offset;
    std::uint32_t alignment;
    std::uint32_t relocations;
    std::uint32_t relocation_count;
    std::uint32_t flags;
    std::uint32_t reserved[3];
};
constexpr std::uint32_t kTypeOfSection = 0xff;
constexpr std::uint32_t kInstructions = 0x80000400;  // pure, some

constexpr std::uint32_t kSymbols = 0x2;
struct SymbolsCommand {
    Command command;
    std::uint32_t offset;
    std::uint32_t count;
    std::uint32_t names;
    std::uint32_t name_bytes;
};

struct Symbol {
    std::uint32_t name;
    std::uint8_t type;
    std::uint8_t section;
    std::uint16_t description;
    std::uint64_t value;
};
constexpr std::uint8_t kOfDebugger = 0xe0;
constexpr std::uint8_t kWhere = 0x0e;
constexpr std::uint8_t kNowhere = 0x0;
constexpr std::uint8_t kInSection = 0x0e;
constexpr std::uint8_t kExternal = 0x01;
constexpr std::uint16_t kWeakDefinition = 0x0080;

constexpr std::uint32_t kUuid = 0x1b;
struct UuidCommand {
    Command command;
    std::uint8_t bytes[16];
};

// Libraries that it needs, weakly, as its own, or when it uses them first.
constexpr std::uint32_t kRequired = 0x80000000;
constexpr std::uint32_t kLibraryKinds[] = {0xc, 0x18 | kRequired, 0x1f | kRequired, 0x20, 0x23 | kRequired};
struct LibraryCommand {
    Command command;
    std::uint32_t name;  // from the beginning of the command
    std::uint32_t times[3];
};

struct UniversalHeader {
    std::uint32_t magic;
    std::uint32_t count;
};
struct UniversalPart {
    std::uint32_t processor;
    std::uint32_t processor_kind;
    std::uint32_t offset;
    std::uint32_t bytes;
    std::uint32_t alignment;
};

template <class T>
std::optional<T> read(std::span<char const> bytes, std::uint64_t offset) {
    if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) {
        return std::nullopt;
    }
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

std::span<char const> part(std::span<char const> bytes, std::uint64_t offset, std::uint64_t count) {
    bool const is_inside = offset <= bytes.size() && count <= bytes.size() - offset;
    return is_inside ? bytes.subspan(offset, count) : std::span<char const>();
}

std::string_view text_at(std::span<char const> texts, std::uint64_t offset) {
    std::span<char const> const text = texts.subspan(std::min<std::uint64_t>(offset, texts.size()));
    return {text.begin(), std::ranges::find(text, '\0')};
}

/// A name in the file, which may fill all of its place.
std::string_view fixed_text(std::span<char const> bytes, std::uint64_t offset) {
    constexpr std::uint64_t most = 16;
    return text_at(part(bytes, offset, most), 0);
}

/// The file for a processor in a universal one; none if there is none.
std::span<char const> part_for(std::span<char const> bytes, MachOProcessor processor) {
    auto const header = read<UniversalHeader>(bytes, 0);
    auto const number = [](std::uint32_t stored) { return __builtin_bswap32(stored); };
    if (!header || number(header->magic) != kUniversalMagic) {
        return bytes;
    }
    std::uint64_t offset = sizeof(UniversalHeader);
    for (std::uint32_t i = 0; i < number(header->count); ++i, offset += sizeof(UniversalPart)) {
        auto const found = read<UniversalPart>(bytes, offset);
        if (!found) {
            break;
        }
        if (number(found->processor) == static_cast<std::uint32_t>(processor)) {
            return part(bytes, number(found->offset), number(found->bytes));
        }
    }
    return {};
}

/// None: this is no file for that processor.
std::optional<Header> header_for(std::span<char const> bytes, MachOProcessor processor) {
    auto const header = read<Header>(bytes, 0);
    bool const fits = header && header->magic == kMagic && header->processor == static_cast<std::uint32_t>(processor);
    return fits ? header : std::nullopt;
}

void add_segment(MachOFile& file, std::span<char const> bytes, std::uint64_t offset, std::uint32_t command_bytes) {
    auto const segment = read<SegmentCommand>(bytes, offset);
    if (!segment || command_bytes < sizeof(SegmentCommand)) {
        return;
    }
    bool const is_writable = (segment->protection & kCanBeWritten) != 0 && (segment->flags & kReadOnlyAfterStart) == 0;
    std::string_view const name = fixed_text(bytes, offset + offsetof(SegmentCommand, name));
    if (name == "__TEXT") {
        file.address = segment->address;
    }
    file.segments.push_back({.name = name,
                             .address = segment->address,
                             .memory_bytes = segment->memory_bytes,
                             .offset = segment->offset,
                             .file_bytes = segment->file_bytes,
                             .is_writable = is_writable});
    std::uint64_t const room = (command_bytes - sizeof(SegmentCommand)) / sizeof(SectionOfSegment);
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(room, segment->section_count); ++i) {
        std::uint64_t const at = offset + sizeof(SegmentCommand) + i * sizeof(SectionOfSegment);
        auto const section = read<SectionOfSegment>(bytes, at);
        if (!section) {
            return;
        }
        file.sections.push_back({.segment = fixed_text(bytes, at + offsetof(SectionOfSegment, segment)),
                                 .name = fixed_text(bytes, at),
                                 .address = section->address,
                                 .bytes = section->bytes,
                                 .offset = section->offset,
                                 .type = static_cast<std::uint8_t>(section->flags & kTypeOfSection),
                                 .is_code = (section->flags & kInstructions) != 0,
                                 .is_writable = is_writable});
    }
}

void add_command(MachOFile& file, std::span<char const> bytes, std::uint64_t offset, Command const& command) {
    if (command.kind == kSegment) {
        add_segment(file, bytes, offset, command.bytes);
    } else if (command.kind == kSymbols) {
        if (auto const symbols = read<SymbolsCommand>(bytes, offset)) {
            file.symbol_table = symbols->offset;
            file.symbol_count = symbols->count;
            file.names = part(bytes, symbols->names, symbols->name_bytes);
        }
    } else if (command.kind == kUuid) {
        if (auto const uuid = read<UuidCommand>(bytes, offset)) {
            file.build.clear();
            for (std::uint8_t const byte : uuid->bytes) {
                file.build += fmt::format("{:02x}", byte);
            }
        }
    } else if (std::ranges::find(kLibraryKinds, command.kind) != std::end(kLibraryKinds)) {
        auto const library = read<LibraryCommand>(bytes, offset);
        file.libraries.push_back(library ? text_at(part(bytes, offset, command.bytes), library->name) : "");
    }
}

}  // namespace

MachOFile mach_o_file(std::span<char const> bytes, MachOProcessor processor) {
    MachOFile file{.bytes = part_for(bytes, processor)};
    auto const header = header_for(file.bytes, processor);
    if (!header) {
        constexpr std::array all{MachOProcessor::x86_64, MachOProcessor::arm64};
        file.is_for_other_processor = std::ranges::any_of(
            all, [&](MachOProcessor other) { return header_for(part_for(bytes, other), other).has_value(); });
        return file;
    }
    file.is_known = true;
    file.type = header->type;
    std::uint64_t offset = sizeof(Header);
    std::uint64_t const end = offset + header->command_bytes;
    for (std::uint32_t i = 0; i < header->command_count && offset < end; ++i) {
        auto const command = read<Command>(file.bytes, offset);
        if (!command || command->bytes < sizeof(Command)) {
            break;
        }
        add_command(file, file.bytes, offset, *command);
        offset += command->bytes;
    }
    return file;
}

MachOFile mach_o_in_memory(void const* header) {
    Header head;
    std::memcpy(&head, header, sizeof(head));
    MachOFile file = mach_o_file({static_cast<char const*>(header), sizeof(Header) + head.command_bytes},
                                 MachOProcessor{head.processor});
    file.symbol_count = 0;  // they are elsewhere
    return file;
}

std::span<char const> MachOFile::content(MachOSection const& section) const {
    return section.is_zero_filled() ? std::span<char const>() : part(bytes, section.offset, section.bytes);
}

std::vector<MachOSymbol> MachOFile::symbols() const {
    std::vector<MachOSymbol> found;
    for (std::uint64_t i = 0; i < symbol_count; ++i) {
        auto const symbol = read<Symbol>(bytes, symbol_table + i * sizeof(Symbol));
        if (!symbol) {
            break;
        }
        std::uint8_t const where = symbol->type & kWhere;
        if ((symbol->type & kOfDebugger) != 0 || (where != kNowhere && where != kInSection)) {
            continue;
        }
        std::string_view name = text_at(names, symbol->name);
        name.remove_prefix(name.starts_with('_') ? 1 : 0);
        bool const is_defined = where == kInSection;
        constexpr unsigned bits_before_library = 8;
        std::size_t const library = symbol->description >> bits_before_library;  // counted from 1 on
        bool const is_in_library = !is_defined && library > 0 && library <= libraries.size();
        found.push_back({.name = name,
                         .section = is_defined ? symbol->section : std::uint8_t{0},
                         .address = symbol->value,
                         .is_defined = is_defined,
                         .is_external = (symbol->type & kExternal) != 0,
                         .is_weak = is_defined && (symbol->description & kWeakDefinition) != 0,
                         .library = is_in_library ? libraries[library - 1] : ""});
    }
    return found;
}

std::string problem_of_mach_o(MachOFile const& file) {
    if (file.is_for_other_processor) {
        return "is for another processor than this Pogosim: build it again here";
    }
    if (!file.is_known) {
        return "is no shared object: make one with 'make sim', or with 'cc -shared -fPIC'";
    }
    if (file.type == MachOFile::kExecutable) {
        return "is an executable: name the shared object that 'make sim' makes beside it, NAME.so";
    }
    if (file.type != MachOFile::kLibrary && file.type != MachOFile::kBundle) {
        return "is no shared object: make one with 'make sim', or with 'cc -shared -fPIC'";
    }
    auto const lies_beyond = [&file](MachOSegment const& segment) {
        return segment.file_bytes > 0 && part(file.bytes, segment.offset, segment.file_bytes).empty();
    };
    if (file.segments.empty() || std::ranges::any_of(file.segments, lies_beyond)) {
        return "is cut off: build it again";
    }
    return "";
}

}  // namespace pogosim
