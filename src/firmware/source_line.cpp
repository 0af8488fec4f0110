#include "firmware/source_line.hpp"

#ifdef POGOSIM_HAS_LIBDW

#include <elfutils/libdw.h>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <vector>

namespace pogosim {

namespace {

struct EndElf {
    void operator()(Elf* elf) const { elf_end(elf); }
};
struct EndDwarf {
    void operator()(Dwarf* dwarf) const { dwarf_end(dwarf); }
};

std::string text_of(Dwarf_Line* line) {
    int number = 0;
    char const* const file = dwarf_linesrc(line, nullptr, nullptr);
    if (file == nullptr || dwarf_lineno(line, &number) != 0 || number == 0) {
        return "";
    }
    return fmt::format("{}:{}", std::filesystem::path(file).filename().string(), number);
}

}  // namespace

std::string source_line(std::span<std::byte const> elf_file, std::uint32_t address) {
    elf_version(EV_CURRENT);
    std::vector<char> copy(reinterpret_cast<char const*>(elf_file.data()),
                           reinterpret_cast<char const*>(elf_file.data()) + elf_file.size());
    std::unique_ptr<Elf, EndElf> const elf(elf_memory(copy.data(), copy.size()));
    std::unique_ptr<Dwarf, EndDwarf> const dwarf(elf ? dwarf_begin_elf(elf.get(), DWARF_C_READ, nullptr) : nullptr);
    Dwarf_CU* unit = nullptr;
    Dwarf_Die entry;
    while (dwarf && dwarf_get_units(dwarf.get(), unit, &unit, nullptr, nullptr, &entry, nullptr) == 0) {
        if (Dwarf_Line* const line = dwarf_getsrc_die(&entry, address)) {
            return text_of(line);
        }
    }
    return "";
}

}  // namespace pogosim

#else

namespace pogosim {

std::string source_line(std::span<std::byte const> /*elf_file*/, std::uint32_t /*address*/) {
    return "";
}

}  // namespace pogosim

#endif
