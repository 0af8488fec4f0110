#include "process/mach_o_symbols.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>

namespace pogosim {

namespace {

using Section = MachOSection;

Section const* section_of(MachOFile const& file, MachOSymbol const& symbol) {
    bool const is_there = symbol.section > 0 && symbol.section <= file.sections.size();
    return is_there ? &file.sections[symbol.section - 1U] : nullptr;
}

bool is_of_threads(Section const& section) {
    return section.type == Section::kThreadRegular || section.type == Section::kThreadZeroFill;
}

/// Variables of the linker and of sanitizers stay as the dynamic linker leaves them.
bool has_variables(Section const& section) {
    bool const is_memory = section.type == Section::kRegular || section.type == Section::kCoalesced ||
                           section.type == Section::kZeroFill || section.type == Section::kLargeZeroFill;
    constexpr std::array kOthers{"__got", "__const", "__cfstring", "__objc_", "__asan_", "__llvm_", "__sancov"};
    return section.is_writable && !section.is_code && is_memory && section.name != "pogo_own" &&
           section.name != "pogo_program" &&
           std::ranges::none_of(kOthers, [&](auto const* other) { return section.name.starts_with(other); });
}

bool has_variables_of_robots(Section const& section) {
    return has_variables(section) && section.name != "pogo_shared";
}

/// Names that the linker gives to the header.
bool is_of_linker(std::string_view name) {
    return name.starts_with("_mh_") || name == "dyld_private" || name == "__dso_handle" || name == "_dso_handle";
}

/// Where the symbols of each section are, in order.
class Places {
public:
    Places(MachOFile const& file, std::vector<MachOSymbol> const& symbols) : file_(file) {
        for (MachOSymbol const& symbol : symbols) {
            if (symbol.is_defined) {
                of_section_[symbol.section].insert(symbol.address);
            }
        }
    }

    /// From a symbol to the next one, or to the end of its section.
    std::uint64_t bytes(MachOSymbol const& symbol) const {
        Section const* const section = section_of(file_, symbol);
        if (section == nullptr || symbol.address < section->address ||
            symbol.address - section->address >= section->bytes) {
            return 0;
        }
        std::set<std::uint64_t> const& places = of_section_.at(symbol.section);
        auto const next = places.upper_bound(symbol.address);
        std::uint64_t const end = section->address + section->bytes;
        return std::min(next == places.end() ? end : *next, end) - symbol.address;
    }

private:
    MachOFile const& file_;
    std::map<std::uint8_t, std::set<std::uint64_t>> of_section_;
};

/// Each variable of threads has a descriptor: two words for the system, and where it is in the memory of a thread.
class ThreadVariables {
public:
    explicit ThreadVariables(MachOFile const& file) : file_(file) {
        std::uint64_t begin = UINT64_MAX;
        for (Section const& section : file.sections) {
            if (is_of_threads(section) && section.bytes > 0) {
                begin = std::min(begin, section.address);
                end_ = std::max(end_, section.address + section.bytes);
            }
        }
        end_ -= std::min(begin, end_);
        for (Section const& section : file.sections) {
            if (section.type == Section::kThreadVariables) {
                std::span<char const> const content = file.content(section);
                for (std::uint64_t at = 0; at + kBytes <= content.size(); at += kBytes) {
                    offsets_.insert(offset_in(content, at));
                }
            }
        }
    }

    std::size_t bytes() const { return offsets_.empty() ? 0 : end_ - std::min(end_, *offsets_.begin()); }

    /// The size of the variable with this descriptor; 0: the file does not say.
    std::size_t bytes_of(Section const& section, std::uint64_t address) const {
        std::span<char const> const content = file_.content(section);
        std::uint64_t const at = address - section.address;
        if (at > content.size() || content.size() - at < kBytes) {
            return 0;
        }
        std::uint64_t const offset = offset_in(content, at);
        auto const next = offsets_.upper_bound(offset);
        return std::max(offset, next == offsets_.end() ? end_ : *next) - offset;
    }

private:
    static constexpr std::uint64_t kWord = sizeof(std::uint64_t);
    static constexpr std::uint64_t kBytes = 3 * kWord;

    static std::uint64_t offset_in(std::span<char const> content, std::uint64_t at) {
        std::uint64_t offset = 0;
        std::memcpy(&offset, content.data() + at + 2 * kWord, kWord);
        return offset;
    }

    MachOFile const& file_;
    std::uint64_t end_ = 0;
    std::set<std::uint64_t> offsets_;
};

/// A static function of every program, see program.c. Compilers may add to its name.
bool is_static_of_every_program(Section const& section, MachOSymbol const& symbol) {
    return section.is_code && !symbol.is_external && symbol.name.starts_with("before_constructors");
}

std::string format_in(MachOFile const& file) {
    for (Section const& section : file.sections) {
        if (!section.is_code && !section.name.starts_with("__unwind") && !section.name.starts_with("__eh_frame")) {
            std::span const bytes = file.content(section);
            if (std::string found = allocating_conversion({bytes.data(), bytes.size()}); !found.empty()) {
                return found;
            }
        }
    }
    return "";
}

/// Left out: what the compiler's code needs in every program, and thread-local variables of the simulator.
bool is_import(MachOSymbol const& symbol) {
    bool const is_of_simulator = symbol.library.find("libpogosim.") != std::string_view::npos;
    return !symbol.is_defined && symbol.is_external && !is_of_simulator && symbol.name != "_tlv_bootstrap" &&
           symbol.name != "dyld_stub_binder";
}

}  // namespace

ProgramSymbols mach_o_symbols(MachOFile const& file) {
    ProgramSymbols found;
    std::vector<MachOSymbol> const symbols = file.symbols();
    Places const places(file, symbols);
    ThreadVariables const threads(file);
    found.bytes_of_threads = threads.bytes();
    found.allocating_format = format_in(file);
    for (Section const& section : file.sections) {
        if (has_variables_of_robots(section) && section.bytes > 0) {
            found.memory.push_back({section.address - file.address, section.address + section.bytes - file.address});
        }
    }
    for (MachOSymbol const& symbol : symbols) {
        if (is_import(symbol)) {
            found.imports.emplace_back(symbol.name);
        }
        Section const* const section = section_of(file, symbol);
        if (section == nullptr || is_of_linker(symbol.name)) {
            continue;
        }
        found.are_known = true;
        found.has_static = found.has_static || is_static_of_every_program(*section, symbol);
        bool const is_of_thread = section->type == Section::kThreadVariables;
        if (is_of_thread || has_variables(*section)) {
            std::size_t const size = is_of_thread ? threads.bytes_of(*section, symbol.address) : places.bytes(symbol);
            if (size > 0) {
                found.variables.push_back({.name = std::string(symbol.name),
                                           .address = symbol.address - file.address,
                                           .bytes = size,
                                           .is_of_thread = is_of_thread});
            }
        }
    }
    return found;
}

namespace {

/// Calls see(symbol) for each function that is in the file.
template <class See>
void for_each_function(MachOFile const& file, std::vector<MachOSymbol> const& symbols, See const& see) {
    for (MachOSymbol const& symbol : symbols) {
        Section const* const section = section_of(file, symbol);
        if (section != nullptr && section->is_code && !is_of_linker(symbol.name)) {
            see(symbol);
        }
    }
}

}  // namespace

std::vector<ProgramFunction> mach_o_functions(MachOFile const& file) {
    std::vector<ProgramFunction> functions;
    for_each_function(file, file.symbols(), [&](MachOSymbol const& symbol) {
        functions.push_back({.symbol = std::string(symbol.name), .address = symbol.address - file.address});
    });
    return functions;
}

std::string mach_o_function_at(MachOFile const& file, std::uintptr_t address) {
    std::vector<MachOSymbol> const symbols = file.symbols();
    Places const places(file, symbols);
    std::string found;
    for_each_function(file, symbols, [&](MachOSymbol const& symbol) {
        std::uint64_t const place = symbol.address - file.address;
        if (address >= place && address - place < places.bytes(symbol)) {
            found = symbol.name;
        }
    });
    return found;
}

std::vector<std::string> mach_o_texts(MachOFile const& file, std::string_view part_of_name) {
    std::vector<std::string> found;
    for (MachOSymbol const& symbol : file.symbols()) {
        Section const* const section = section_of(file, symbol);
        if (section == nullptr || symbol.address < section->address ||
            symbol.name.find(part_of_name) == std::string_view::npos) {
            continue;
        }
        std::span<char const> const content = file.content(*section);
        std::uint64_t const at = std::min<std::uint64_t>(symbol.address - section->address, content.size());
        std::span<char const> const text = content.subspan(at);
        found.emplace_back(text.begin(), std::ranges::find(text, '\0'));
    }
    return found;
}

std::vector<std::string> mach_o_variables_of_all_copies(MachOFile const& file) {
    std::vector<std::string> found;
    for (MachOSymbol const& symbol : file.symbols()) {
        Section const* const section = section_of(file, symbol);
        if (symbol.is_weak && symbol.is_external && section != nullptr && has_variables(*section)) {
            found.emplace_back(symbol.name);
        }
    }
    return found;
}

}  // namespace pogosim
