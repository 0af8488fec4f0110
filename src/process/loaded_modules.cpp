#include "process/loaded_modules.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>

#ifdef __linux__
#include <fmt/format.h>
#include <link.h>

#include <cstring>
#include <string_view>
#include <system_error>

#include "process/own_executable.hpp"
#else
#include <mach-o/dyld.h>
#include <mach/mach.h>

#include "process/mach_o_file.hpp"
#endif

namespace pogosim {

#ifdef __linux__

namespace {

/// The bytes of the note with the build id, in hexadecimal digits; empty: there is none.
std::string build_id(char const* notes, std::size_t bytes) {
    auto const padded = [](std::size_t count) { return (count + 3U) & ~std::size_t{3}; };
    for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= bytes;) {
        ElfW(Nhdr) note;
        std::memcpy(&note, notes + at, sizeof(note));
        std::size_t const name = at + sizeof(note);
        std::size_t const value = name + padded(note.n_namesz);
        if (value + note.n_descsz > bytes) {
            break;
        }
        if (note.n_type == NT_GNU_BUILD_ID &&
            std::string_view(notes + name, note.n_namesz) == std::string_view("GNU", 4)) {
            std::string digits;
            for (std::size_t i = 0; i < note.n_descsz; ++i) {
                digits += fmt::format("{:02x}", static_cast<unsigned char>(notes[value + i]));
            }
            return digits;
        }
        at = value + padded(note.n_descsz);
    }
    return "";
}

int add_module(dl_phdr_info* info, std::size_t /*bytes*/, void* into) {
    std::filesystem::path const file = info->dlpi_name;
    LoadedModule found{.name = file.filename().string(), .begin = UINT64_MAX, .end = 0, .build = {}};
    for (ElfW(Half) i = 0; i < info->dlpi_phnum; ++i) {
        ElfW(Phdr) const& segment = info->dlpi_phdr[i];
        std::uint64_t const begin = info->dlpi_addr + segment.p_vaddr;
        if (segment.p_type == PT_LOAD) {
            found.begin = std::min(found.begin, begin);
            found.end = std::max(found.end, begin + segment.p_memsz);
        } else if (segment.p_type == PT_NOTE && found.build.empty()) {
            // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
            found.build = build_id(reinterpret_cast<char const*>(begin), segment.p_memsz);
        }
    }
    if (found.build.empty()) {
        std::error_code error;
        auto const size = std::filesystem::file_size(file.empty() ? own_executable() : file, error);
        found.build = error ? "" : fmt::format("{} bytes", size);
    }
    static_cast<std::vector<LoadedModule>*>(into)->push_back(std::move(found));
    return 0;
}

}  // namespace

std::vector<LoadedModule> loaded_modules() {
    std::vector<LoadedModule> modules;
    dl_iterate_phdr(add_module, &modules);
    return modules;
}

std::vector<MappedMemory> mapped_memory() {
    std::vector<MappedMemory> pieces;
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        MappedMemory piece{.is_heap = line.ends_with("[heap]")};
        if (std::sscanf(line.c_str(), "%" SCNx64 "-%" SCNx64, &piece.begin, &piece.end) == 2) {
            pieces.push_back(piece);
        }
    }
    return pieces;
}

#else

std::vector<LoadedModule> loaded_modules() {
    std::vector<LoadedModule> modules;
    for (std::uint32_t i = 0; i < _dyld_image_count(); ++i) {
        void const* const header = _dyld_get_image_header(i);
        char const* const path = _dyld_get_image_name(i);
        if (header == nullptr || path == nullptr) {
            continue;  // another thread has unloaded it
        }
        MachOFile const file = mach_o_in_memory(header);
        bool const is_executable = file.type == MachOFile::kExecutable;
        LoadedModule found{.name = is_executable ? "" : std::filesystem::path(path).filename().string(),
                           .begin = reinterpret_cast<std::uint64_t>(header),
                           .end = reinterpret_cast<std::uint64_t>(header),
                           .build = file.build};
        for (MachOSegment const& segment : file.segments) {
            // Nothing leads to what is before the header, nor to what the dynamic linker alone reads.
            if (segment.address >= file.address && segment.name != "__LINKEDIT") {
                found.end = std::max(found.end, found.begin + (segment.address - file.address) + segment.memory_bytes);
            }
        }
        modules.push_back(std::move(found));
    }
    return modules;
}

std::vector<MappedMemory> mapped_memory() {
    std::vector<MappedMemory> pieces;
    vm_address_t address = 0;
    for (natural_t depth = 0;;) {
        vm_size_t bytes = 0;
        vm_region_submap_info_data_64_t info = {};
        mach_msg_type_number_t count = VM_REGION_SUBMAP_INFO_COUNT_64;
        if (vm_region_recurse_64(mach_task_self(), &address, &bytes, &depth,
                                 reinterpret_cast<vm_region_recurse_info_t>(&info), &count) != KERN_SUCCESS) {
            return pieces;
        }
        if (info.is_submap != 0) {
            ++depth;
            continue;
        }
        if (info.protection != VM_PROT_NONE) {
            pieces.push_back({.begin = address, .end = address + bytes});
        }
        address += bytes;
    }
}

#endif

LoadedModule const* module_at(std::vector<LoadedModule> const& modules, void const* place) {
    auto const address = reinterpret_cast<std::uint64_t>(place);
    auto const found = std::ranges::find_if(
        modules, [address](LoadedModule const& module) { return address >= module.begin && address < module.end; });
    return found == modules.end() ? nullptr : &*found;
}

}  // namespace pogosim
