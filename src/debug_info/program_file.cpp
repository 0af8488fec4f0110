#include "debug_info/program_file.hpp"

#include <gelf.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>

namespace shared_state {

namespace {

void for_each_section(Elf* elf, std::function<void(Elf_Scn*, GElf_Shdr const&)> const& look) {
    for (Elf_Scn* section = elf_nextscn(elf, nullptr); section; section = elf_nextscn(elf, section)) {
        GElf_Shdr header;
        if (gelf_getshdr(section, &header)) {
            look(section, header);
        }
    }
}

bool holds(GElf_Shdr const& header, uint64_t address) {
    // Thread-local sections share addresses with others.
    return (header.sh_flags & SHF_ALLOC) && !(header.sh_flags & SHF_TLS) && address >= header.sh_addr &&
           address - header.sh_addr < header.sh_size;
}

// Sections that the loader fills or reads before the program starts, and that are never written afterwards. Sanitizers
// leave a pointer of theirs in .preinit_array, with debug information.
bool is_for_the_loader(GElf_Shdr const& header, std::string const& name) {
    return header.sh_type == SHT_PREINIT_ARRAY || header.sh_type == SHT_INIT_ARRAY ||
           header.sh_type == SHT_FINI_ARRAY || name.starts_with(".data.rel.ro");
}

}  // namespace

ProgramFile::ProgramFile(std::string const& path) : file_(path) {
    if (!file_.is_open()) {
        throw ProgramError(path + ": " + std::strerror(errno));
    }
    if (!debug_info()) {
        throw ProgramError(path + ": no debug information; compile and link with -g (" + dwarf_errmsg(-1) + ")");
    }
    elf_ = dwarf_getelf(debug_info());
    GElf_Ehdr header;
    if (!gelf_getehdr(elf_, &header) || header.e_type == ET_REL) {
        throw ProgramError(path + ": not linked yet; specify the linked program");
    }
    read_symbols();
}

ProgramFile::Section ProgramFile::section_at(uint64_t address) const {
    Section found;
    std::size_t names = 0;
    elf_getshdrstrndx(elf_, &names);
    for_each_section(elf_, [&](Elf_Scn*, GElf_Shdr const& header) {
        if (holds(header, address)) {
            char const* name = elf_strptr(elf_, names, header.sh_name);
            found.name = name ? name : "";
            found.writable = (header.sh_flags & SHF_WRITE) && !is_for_the_loader(header, found.name);
        }
    });
    return found;
}

std::string ProgramFile::text_at(uint64_t address) const {
    std::string text;
    for_each_section(elf_, [&](Elf_Scn* section, GElf_Shdr const& header) {
        if (!holds(header, address) || header.sh_type == SHT_NOBITS) {
            return;
        }
        Elf_Data const* data = elf_rawdata(section, nullptr);
        uint64_t const start = address - header.sh_addr;
        if (data && data->d_buf && start < data->d_size) {
            auto const* bytes = static_cast<char const*>(data->d_buf) + start;
            text.assign(bytes, strnlen(bytes, data->d_size - start));
        }
    });
    return text;
}

std::string ProgramFile::symbol_at(uint64_t address) const {
    auto const found = symbols_.find(address);
    return found == symbols_.end() ? "" : found->second;
}

bool ProgramFile::is_for_sdk() const {
    auto const is_mark = [](auto const& symbol) { return symbol.second == "pogosim_is_for_sdk"; };
    return std::any_of(symbols_.begin(), symbols_.end(), is_mark);
}

bool ProgramFile::has_guard(std::string const& symbol) const {
    // _ZZ6chancevE1x is x in chance(), _ZGVZ6chancevE1x its guard (Itanium C++ ABI, 5.1.5.1).
    return symbol.starts_with("_Z") && guards_.contains("_ZGV" + symbol.substr(2));
}

void ProgramFile::read_symbols() {
    for_each_section(elf_, [&](Elf_Scn* section, GElf_Shdr const& header) {
        if (header.sh_type != SHT_SYMTAB || header.sh_entsize == 0) {
            return;
        }
        Elf_Data* data = elf_getdata(section, nullptr);
        for (std::size_t index = 0; data && index < header.sh_size / header.sh_entsize; index++) {
            GElf_Sym symbol;
            if (!gelf_getsym(data, static_cast<int>(index), &symbol) || GELF_ST_TYPE(symbol.st_info) != STT_OBJECT) {
                continue;
            }
            char const* name = elf_strptr(elf_, header.sh_link, symbol.st_name);
            if (name && std::string(name).starts_with("_ZGV")) {
                guards_.emplace(name, symbol.st_value);
            } else if (name) {
                symbols_.emplace(symbol.st_value, name);
            }
        }
    });
}

}  // namespace shared_state
