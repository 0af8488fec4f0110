#include "robot/program_symbols.hpp"

#include <algorithm>
#include <string_view>

#include "robot/elf_file.hpp"

namespace pogosim {

#ifdef __linux__

namespace {

std::string_view text_at(std::span<char const> texts, std::size_t offset) {
    std::span<char const> const text = texts.subspan(std::min(offset, texts.size()));
    return {text.begin(), std::ranges::find(text, '\0')};
}

/// Only the linker writes there, when the program starts.
bool is_constant_after_start(ElfFile const& file, Elf64_Addr address) {
    return std::ranges::any_of(file.segments, [&](Elf64_Phdr const& segment) {
        return segment.p_type == PT_GNU_RELRO && address >= segment.p_vaddr &&
               address - segment.p_vaddr < segment.p_memsz;
    });
}

bool is_writable(ElfFile const& file, Elf64_Sym const& symbol) {
    if (symbol.st_shndx >= file.sections.size()) {
        return false;
    }
    return (file.sections[symbol.st_shndx].sh_flags & SHF_WRITE) != 0 &&
           !is_constant_after_start(file, symbol.st_value);
}

/// Calls see(symbol, name) for each symbol of a table.
template <class See>
void for_each_symbol(ElfFile const& file, Elf64_Shdr const& table, See const& see) {
    if (table.sh_link >= file.sections.size()) {
        return;
    }
    Elf64_Shdr const& text_table = file.sections[table.sh_link];
    std::span const texts = elf_array<char>(file.bytes, text_table.sh_offset, text_table.sh_size);
    for (Elf64_Sym const& symbol : elf_symbols(file, table)) {
        see(symbol, text_at(texts, symbol.st_name));
    }
}

}  // namespace

ProgramSymbols symbols_of(std::span<char const> bytes) {
    ProgramSymbols found;
    ElfFile const file = elf_file(bytes);
    for (Elf64_Shdr const& section : file.sections) {
        if (section.sh_type == SHT_SYMTAB) {
            found.are_known = true;
            for_each_symbol(file, section, [&](Elf64_Sym const& symbol, std::string_view name) {
                auto const type = ELF64_ST_TYPE(symbol.st_info);
                bool const is_variable = type == STT_OBJECT || type == STT_COMMON || type == STT_TLS;
                bool const is_here = symbol.st_shndx != SHN_UNDEF && symbol.st_size > 0;
                if (!is_variable || !is_here || (type != STT_TLS && !is_writable(file, symbol))) {
                    return;
                }
                if (auto const version = name.find('@'); version != std::string_view::npos) {
                    found.imports.emplace_back(name.substr(0, version));  // a library's, which lies in the program
                } else {
                    found.variables.push_back({.name = std::string(name),
                                               .address = symbol.st_value,
                                               .bytes = symbol.st_size,
                                               .is_of_thread = type == STT_TLS});
                }
            });
        } else if (section.sh_type == SHT_DYNSYM) {
            for_each_symbol(file, section, [&](Elf64_Sym const& symbol, std::string_view name) {
                // Variables of each thread are the simulator's.
                if (symbol.st_shndx == SHN_UNDEF && !name.empty() && ELF64_ST_TYPE(symbol.st_info) != STT_TLS) {
                    found.imports.emplace_back(name);
                }
            });
        }
    }
    return found;
}

#else

ProgramSymbols symbols_of(std::span<char const> /*bytes*/) {
    return {};
}

#endif

}  // namespace pogosim
