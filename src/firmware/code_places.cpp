#include "firmware/code_places.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#ifdef POGOSIM_HAS_LIBDW
#include <dwarf.h>
#include <elfutils/libdw.h>
#endif

namespace pogosim {

std::uint32_t CodePlaces::function_number(std::string_view name) {
    auto const found = number_of_function_.find(name);
    if (found != number_of_function_.end()) {
        return found->second;
    }
    auto const number = static_cast<std::uint32_t>(functions_.size());
    functions_.emplace_back(name);
    number_of_function_.emplace(name, number);
    return number;
}

std::uint32_t CodePlaces::chain_number(Chain const& chain) {
    auto const [found, is_new] = number_of_chain_.try_emplace(chain, static_cast<std::uint32_t>(chains_.size()));
    if (is_new) {
        chains_.push_back(chain);
    }
    return found->second;
}

std::uint32_t CodePlaces::line_number(std::string const& file, int line) {
    auto const number = static_cast<std::uint32_t>(lines_.size());
    auto const [found, is_new] = number_of_line_.try_emplace(std::pair(file, line), number);
    if (is_new) {
        lines_.push_back({file, line});
    }
    return found->second;
}

CodePlaces::CodePlaces(FirmwareProgram const& program) : address_(program.firmware.code.address) {
    std::size_t const words = program.firmware.code.bytes() / 4;
    line_of_.assign(words, line_number("", 0));
    chain_of_.resize(words);
    read_symbols(program);
    read_debug_information(program);
}

/// A function without a size, of assembler, goes on to the next one.
void CodePlaces::read_symbols(FirmwareProgram const& program) {
    std::uint32_t chain = chain_number({function_number("?")});
    std::vector<FirmwareSymbol> const& symbols = program.firmware.symbols;
    std::size_t next = 0;
    is_entry_.resize(chain_of_.size());
    for (std::size_t word = 0; word < chain_of_.size(); ++word) {
        std::uint32_t const address = address_ + static_cast<std::uint32_t>(4 * word);
        for (; next < symbols.size() && symbols[next].address <= address; ++next) {
            if (symbols[next].is_function && symbols[next].address == address) {
                chain = chain_number({function_number(symbols[next].name)});
                is_entry_[word] = true;
            }
        }
        chain_of_[word] = chain;
    }
}

#ifdef POGOSIM_HAS_LIBDW

/// Reads functions that are a part of others, and lines.
class DebugReader {
public:
    explicit DebugReader(CodePlaces& places) : places_(places) {}

    void read_unit(Dwarf_Die& unit) {
        unit_ = &unit;
        for_each_child(unit, [this](Dwarf_Die& child) { look_into(child, {}); });
    }

private:
    template <class See>
    static void for_each_child(Dwarf_Die& parent, See const& see) {
        Dwarf_Die child;
        for (bool found = dwarf_child(&parent, &child) == 0; found; found = dwarf_siblingof(&child, &child) == 0) {
            see(child);
        }
    }

    /// Calls see(word) for each word of code between two addresses.
    template <class See>
    void for_each_word(Dwarf_Addr begin, Dwarf_Addr end, See const& see) const {
        Dwarf_Addr const code_end = Dwarf_Addr{places_.address_} + 4 * places_.chain_of_.size();
        end = std::min(end, code_end);
        for (Dwarf_Addr address = std::max<Dwarf_Addr>(begin, places_.address_); address < end; address += 4) {
            see((static_cast<std::uint32_t>(address) - places_.address_) / 4);
        }
    }

    /// Calls see(word) for each word of code of a function or of a part of one.
    template <class See>
    void for_each_word_of(Dwarf_Die& entry, See const& see) const {
        Dwarf_Addr base = 0;
        Dwarf_Addr begin = 0;
        Dwarf_Addr end = 0;
        for (std::ptrdiff_t offset = 0; (offset = dwarf_ranges(&entry, offset, &base, &begin, &end)) > 0;) {
            for_each_word(begin, end, see);
        }
    }

    void look_into(Dwarf_Die& entry, std::optional<CodePlaces::Chain> const& around) {
        int const tag = dwarf_tag(&entry);
        std::optional<CodePlaces::Chain> chain = around;
        if (tag == DW_TAG_subprogram) {
            chain = {};
            mark_function(entry, chain);
        } else if (tag == DW_TAG_inlined_subroutine && around) {
            mark_inlined(entry, *chain);
        }
        for_each_child(entry, [&](Dwarf_Die& child) { look_into(child, chain); });
    }

    /// The linker knows a function that stands alone: its chain begins with that name.
    void mark_function(Dwarf_Die& entry, std::optional<CodePlaces::Chain>& chain) {
        Dwarf_Addr begin = 0;
        bool const is_there = dwarf_entrypc(&entry, &begin) == 0 && begin != 0;
        if (is_there && places_.is_code(static_cast<std::uint32_t>(begin))) {
            chain = places_.chain(places_.chain_of(static_cast<std::uint32_t>(begin)));
            mark_lines(entry);
        } else {
            chain.reset();
        }
    }

    void mark_inlined(Dwarf_Die& entry, CodePlaces::Chain& chain) {
        char const* const name = dwarf_diename(&entry);
        chain.push_back(places_.function_number(name == nullptr ? "?" : name));
        std::uint32_t const number = places_.chain_number(chain);
        for_each_word_of(entry, [&](std::uint32_t word) { places_.chain_of_[word] = number; });
    }

    /// Line tables also list functions that the linker has left out, at address 0, so only those that are there count.
    void mark_lines(Dwarf_Die& function) {
        for_each_word_of(function, [this](std::uint32_t word) {
            Dwarf_Line* const line = dwarf_getsrc_die(unit_, places_.address_ + Dwarf_Addr{4} * word);
            char const* const file = line == nullptr ? nullptr : dwarf_linesrc(line, nullptr, nullptr);
            int number = 0;
            if (file != nullptr && dwarf_lineno(line, &number) == 0) {
                places_.line_of_[word] = places_.line_number(std::filesystem::path(file).filename().string(), number);
            }
        });
    }

    Dwarf_Die* unit_ = nullptr;
    CodePlaces& places_;
};

void CodePlaces::read_debug_information(FirmwareProgram const& program) {
    struct EndElf {
        void operator()(Elf* elf) const { elf_end(elf); }
    };
    struct EndDwarf {
        void operator()(Dwarf* dwarf) const { dwarf_end(dwarf); }
    };
    elf_version(EV_CURRENT);
    auto const* const bytes = reinterpret_cast<char const*>(program.bytes.data());
    std::vector<char> copy(bytes, bytes + program.bytes.size());
    std::unique_ptr<Elf, EndElf> const elf(elf_memory(copy.data(), copy.size()));
    std::unique_ptr<Dwarf, EndDwarf> const dwarf(elf ? dwarf_begin_elf(elf.get(), DWARF_C_READ, nullptr) : nullptr);
    Dwarf_CU* unit = nullptr;
    Dwarf_Die entry;
    DebugReader reader(*this);
    while (dwarf && dwarf_get_units(dwarf.get(), unit, &unit, nullptr, nullptr, &entry, nullptr) == 0) {
        reader.read_unit(entry);
    }
}

#else

void CodePlaces::read_debug_information(FirmwareProgram const& /*program*/) {}

#endif

}  // namespace pogosim
