// The parts of a program's file (ELF). The file need not be well-formed: parts that lie beyond its end count as
// missing.
#pragma once

#ifdef __linux__

#include <elf.h>

#include <cstddef>
#include <cstring>
#include <span>

namespace pogosim {

/// `count` structures that begin at `offset`; null if the file has no room for them.
template <class T>
T const* elf_at(std::span<char const> bytes, std::size_t offset, std::size_t count = 1) {
    bool const inside = offset <= bytes.size() && count <= (bytes.size() - offset) / sizeof(T);
    return inside ? reinterpret_cast<T const*>(bytes.data() + offset) : nullptr;
}

/// The same; none if the file has no room for all of them.
template <class T>
std::span<T const> elf_array(std::span<char const> bytes, std::size_t offset, std::size_t count) {
    T const* const first = elf_at<T>(bytes, offset, count);
    return {first, first != nullptr ? count : 0};
}

struct ElfFile {
    std::span<char const> bytes;
    Elf64_Ehdr const* header = nullptr;  // null: it is no such file
    std::span<Elf64_Shdr const> sections{};
    std::span<Elf64_Phdr const> segments{};
};

inline ElfFile elf_file(std::span<char const> bytes) {
    auto const* const header = elf_at<Elf64_Ehdr>(bytes, 0);
    if (header == nullptr || std::memcmp(header->e_ident, ELFMAG, SELFMAG) != 0) {
        return {.bytes = bytes};
    }
    return {.bytes = bytes,
            .header = header,
            .sections = elf_array<Elf64_Shdr>(bytes, header->e_shoff, header->e_shnum),
            .segments = elf_array<Elf64_Phdr>(bytes, header->e_phoff, header->e_phnum)};
}

/// The entries of a section that is a table of T.
inline std::span<Elf64_Sym const> elf_symbols(ElfFile const& file, Elf64_Shdr const& table) {
    return elf_array<Elf64_Sym>(file.bytes, table.sh_offset, table.sh_size / sizeof(Elf64_Sym));
}

}  // namespace pogosim

#endif
