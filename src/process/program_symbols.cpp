#include "process/program_symbols.hpp"

#include <cxxabi.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <utility>

#ifdef __linux__
#include "process/elf_file.hpp"
#else
#include "process/mach_o_symbols.hpp"
#endif

namespace pogosim {

bool ProgramSymbols::has_guard(std::string const& symbol) const {
    // _ZGVZ4namevE1n for _ZZ4namevE1n (Itanium C++ ABI, 5.1.5.1)
    return symbol.starts_with("_Z") &&
           std::ranges::find(variables, "_ZGV" + symbol.substr(2), &Variable::name) != variables.end();
}

std::string name_by_symbol(std::string const& symbol) {
    // Other names would be taken for types: "t" is unsigned short.
    if (symbol.starts_with("_Z")) {
        int status = 0;
        std::unique_ptr<char, void (*)(void*)> const demangled(
            abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status), std::free);
        if (demangled != nullptr) {
            return demangled.get();
        }
    }
    std::size_t const dot = symbol.find('.');
    bool const is_numbered =
        dot != std::string::npos && symbol.find_first_not_of("0123456789.", dot) == std::string::npos;
    std::string name = is_numbered ? symbol.substr(0, dot) : symbol;
    if (std::size_t const inner = name.find('.'); inner != std::string::npos) {
        name.replace(inner, 1, "::");
    }
    return name;
}

std::string ProgramFunction::name() const {
    std::string const written = name_by_symbol(symbol);
    std::size_t const parameters = written.find('(', written.starts_with('(') ? 1 : 0);  // "(anonymous namespace)::f()"
    return written.substr(0, parameters);
}

std::string allocating_conversion(std::string_view bytes) {
    constexpr std::string_view kDigits = "0123456789$\'";
    for (std::size_t at = bytes.find('%'); at != std::string_view::npos; at = bytes.find('%', at + 1)) {
        std::size_t const letter = bytes.find_first_not_of(kDigits, at + 1);
        if (letter == std::string_view::npos || (bytes[letter] != 'm' && bytes[letter] != 'a')) {
            continue;
        }
        std::size_t const kind = bytes.find_first_not_of('l', letter + 1);
        if (kind != std::string_view::npos && std::string_view("sScC[").find(bytes[kind]) != std::string_view::npos) {
            return std::string(bytes.substr(at, kind + 1 - at));
        }
    }
    return "";
}

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

std::string_view name_of(ElfFile const& file, Elf64_Shdr const& section) {
    if (file.header->e_shstrndx >= file.sections.size()) {
        return "";
    }
    Elf64_Shdr const& names = file.sections[file.header->e_shstrndx];
    return text_at(elf_array<char>(file.bytes, names.sh_offset, names.sh_size), section.sh_name);
}

/// Variables of the linker and of sanitizers stay as the dynamic linker leaves them.
bool has_variables_of_robots(ElfFile const& file, Elf64_Shdr const& section) {
    constexpr std::uint64_t kWritable = SHF_WRITE | SHF_ALLOC;
    bool const is_memory = section.sh_type == SHT_PROGBITS || section.sh_type == SHT_NOBITS;
    if (!is_memory || (section.sh_flags & (kWritable | SHF_TLS)) != kWritable) {
        return false;
    }
    constexpr std::array kOthers{".got", ".data.rel.ro", ".tm_clone_table", ".ctors",   ".dtors",
                                 ".jcr", "pogo_shared",  "asan_",           "__sancov", "__llvm_"};
    std::string_view const name = name_of(file, section);
    return std::ranges::none_of(kOthers, [&](std::string_view other) { return name.starts_with(other); });
}

void take_out(std::vector<ProgramSymbols::Piece>& pieces, ProgramSymbols::Piece gap) {
    std::vector<ProgramSymbols::Piece> rest;
    for (ProgramSymbols::Piece const& piece : pieces) {
        ProgramSymbols::Piece const before{piece.begin, std::min(piece.end, std::max(piece.begin, gap.begin))};
        ProgramSymbols::Piece const after{std::max(piece.begin, std::min(piece.end, std::max(gap.end, before.end))),
                                          piece.end};
        for (ProgramSymbols::Piece const& part : {before, after}) {
            if (part.begin < part.end) {
                rest.push_back(part);
            }
        }
    }
    pieces = std::move(rest);
}

/// A static function of every program, see program.c. Compilers may add to its name.
bool is_static_of_every_program(Elf64_Sym const& symbol, std::string_view name) {
    return ELF64_ST_BIND(symbol.st_info) == STB_LOCAL && ELF64_ST_TYPE(symbol.st_info) == STT_FUNC &&
           name.starts_with("before_constructors");
}

/// The first conversion of that kind among the texts of a program, which are neither code nor of the linker.
std::string allocating_format(ElfFile const& file) {
    for (Elf64_Shdr const& section : file.sections) {
        bool const may_have_texts = section.sh_type == SHT_PROGBITS && (section.sh_flags & SHF_ALLOC) != 0 &&
                                    (section.sh_flags & SHF_EXECINSTR) == 0;
        if (may_have_texts && !name_of(file, section).starts_with(".eh_frame")) {
            std::span const bytes = elf_array<char>(file.bytes, section.sh_offset, section.sh_size);
            if (std::string found = allocating_conversion({bytes.data(), bytes.size()}); !found.empty()) {
                return found;
            }
        }
    }
    return "";
}

std::uint32_t copy_relocation(ElfFile const& file) {
    switch (file.header->e_machine) {
        case EM_AARCH64:
            return R_AARCH64_COPY;
        case EM_RISCV:
            return R_RISCV_COPY;
        default:
            return R_X86_64_COPY;
    }
}

/// Variables of libraries may lie in an executable that uses them: stdout, std::cout.
void take_out_variables_of_libraries(ElfFile const& file, std::vector<ProgramSymbols::Piece>& pieces) {
    std::uint32_t const copy = copy_relocation(file);
    for (Elf64_Shdr const& section : file.sections) {
        if (section.sh_type != SHT_RELA || section.sh_link >= file.sections.size()) {
            continue;
        }
        std::span const symbols = elf_symbols(file, file.sections[section.sh_link]);
        for (Elf64_Rela const& relocation :
             elf_array<Elf64_Rela>(file.bytes, section.sh_offset, section.sh_size / sizeof(Elf64_Rela))) {
            std::size_t const symbol = ELF64_R_SYM(relocation.r_info);
            if (ELF64_R_TYPE(relocation.r_info) == copy && symbol < symbols.size()) {
                take_out(pieces, {relocation.r_offset, relocation.r_offset + symbols[symbol].st_size});
            }
        }
    }
}

std::vector<ProgramSymbols::Piece> memory_of_robots(ElfFile const& file) {
    std::vector<ProgramSymbols::Piece> pieces;
    for (Elf64_Shdr const& section : file.sections) {
        if (has_variables_of_robots(file, section) && section.sh_size > 0) {
            pieces.push_back({section.sh_addr, section.sh_addr + section.sh_size});
        }
    }
    if (file.header != nullptr) {
        take_out_variables_of_libraries(file, pieces);
    }
    for (Elf64_Phdr const& segment : file.segments) {
        if (segment.p_type == PT_GNU_RELRO) {
            take_out(pieces, {segment.p_vaddr, segment.p_vaddr + segment.p_memsz});
        }
    }
    return pieces;
}

}  // namespace

ProgramSymbols symbols_of(std::span<char const> bytes) {
    ProgramSymbols found;
    ElfFile const file = elf_file(bytes);
    found.memory = memory_of_robots(file);
    found.allocating_format = allocating_format(file);
    for (Elf64_Phdr const& segment : file.segments) {
        found.bytes_of_threads += segment.p_type == PT_TLS ? segment.p_memsz : 0;
    }
    for (Elf64_Shdr const& section : file.sections) {
        if (section.sh_type == SHT_SYMTAB) {
            found.are_known = true;
            for_each_symbol(file, section, [&](Elf64_Sym const& symbol, std::string_view name) {
                found.has_static = found.has_static || is_static_of_every_program(symbol, name);
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
                // Thread-local variables are those of the simulator.
                if (symbol.st_shndx == SHN_UNDEF && !name.empty() && ELF64_ST_TYPE(symbol.st_info) != STT_TLS) {
                    found.imports.emplace_back(name);
                }
            });
        }
    }
    return found;
}

namespace {

/// Calls see(symbol, name) for each function that is in the file.
template <class See>
void for_each_function(std::span<char const> bytes, See const& see) {
    ElfFile const file = elf_file(bytes);
    for (Elf64_Shdr const& section : file.sections) {
        if (section.sh_type == SHT_SYMTAB || section.sh_type == SHT_DYNSYM) {
            for_each_symbol(file, section, [&](Elf64_Sym const& symbol, std::string_view name) {
                if (ELF64_ST_TYPE(symbol.st_info) == STT_FUNC && symbol.st_shndx != SHN_UNDEF) {
                    see(symbol, name);
                }
            });
        }
    }
}

}  // namespace

std::vector<ProgramFunction> functions_of(std::span<char const> bytes) {
    std::vector<ProgramFunction> functions;
    for_each_function(bytes, [&](Elf64_Sym const& symbol, std::string_view name) {
        functions.push_back({.symbol = std::string(name), .address = symbol.st_value});
    });
    return functions;
}

std::string function_at(std::span<char const> bytes, std::uintptr_t address) {
    std::string found;
    for_each_function(bytes, [&](Elf64_Sym const& symbol, std::string_view name) {
        if (address >= symbol.st_value && address - symbol.st_value < symbol.st_size) {
            found = name;
        }
    });
    return found;
}

std::vector<std::string> texts_of(std::span<char const> bytes, std::string_view part_of_name) {
    ElfFile const file = elf_file(bytes);
    std::vector<std::string> found;
    for (Elf64_Shdr const& table : file.sections) {
        if (table.sh_type != SHT_SYMTAB) {
            continue;
        }
        for_each_symbol(file, table, [&](Elf64_Sym const& symbol, std::string_view name) {
            if (symbol.st_shndx < file.sections.size() && name.find(part_of_name) != std::string_view::npos) {
                Elf64_Shdr const& section = file.sections[symbol.st_shndx];
                std::span const text = elf_array<char>(
                    file.bytes, section.sh_offset + (symbol.st_value - section.sh_addr), symbol.st_size);
                found.emplace_back(text.begin(), std::ranges::find(text, '\0'));
            }
        });
    }
    return found;
}

#else

ProgramSymbols symbols_of(std::span<char const> bytes) {
    return mach_o_symbols(mach_o_file(bytes));
}

std::vector<ProgramFunction> functions_of(std::span<char const> bytes) {
    return mach_o_functions(mach_o_file(bytes));
}

std::string function_at(std::span<char const> bytes, std::uintptr_t address) {
    return mach_o_function_at(mach_o_file(bytes), address);
}

std::vector<std::string> texts_of(std::span<char const> bytes, std::string_view part_of_name) {
    return mach_o_texts(mach_o_file(bytes), part_of_name);
}

#endif

}  // namespace pogosim
