// The static objects of programs on macOS.
#include <dlfcn.h>
#include <mach-o/dyld.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "process/constructors.hpp"
#include "process/mach_o_file.hpp"

namespace pogosim {

namespace {

/// A part of a file in memory, by what the file says of its place.
std::byte* place_of(MachOFile const& file, void const* header, std::uint64_t address) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
    return reinterpret_cast<std::byte*>(reinterpret_cast<std::uint64_t>(header) + (address - file.address));
}

template <class T>
std::span<T const> array_in(MachOFile const& file, void const* header, MachOSection const& section) {
    return {reinterpret_cast<T const*>(place_of(file, header, section.address)), section.bytes / sizeof(T)};
}

LoadedObject object_with(void const* header) {
    MachOFile const file = mach_o_in_memory(header);
    LoadedObject found{.load_address = reinterpret_cast<std::uintptr_t>(header)};
    for (MachOSegment const& segment : file.segments) {
        if (segment.is_writable && segment.memory_bytes > 0) {
            found.writable.emplace_back(place_of(file, header, segment.address), segment.memory_bytes);
        }
    }
    for (MachOSection const& section : file.sections) {
        if (section.type == MachOSection::kInitializerOffsets) {
            for (std::uint32_t const offset : array_in<std::uint32_t>(file, header, section)) {
                std::byte* const function = place_of(file, header, file.address + offset);
                found.initializers.push_back(reinterpret_cast<void (*)()>(function));
            }
        }
        bool const is_last = section.type == MachOSection::kFinalizers;
        if (is_last || section.type == MachOSection::kInitializers) {
            auto const functions = array_in<void (*)()>(file, header, section);
            std::vector<void (*)()>& all = is_last ? found.finalizers : found.initializers;
            all.insert(all.end(), functions.begin(), functions.end());
        }
    }
    return found;
}

}  // namespace

LoadedObject loaded_object_at(void const* place) {
    Dl_info info = {};
    bool const is_known = dladdr(place, &info) != 0 && info.dli_fbase != nullptr;
    return is_known ? object_with(info.dli_fbase) : LoadedObject{};
}

namespace {

/// A file has been loaded, and its functions have not run yet. On this system they run in the order in which files were
/// linked, so no function of ours comes before those of the program; but the program says which are ours (program.h).
void note_loaded(mach_header const* header, std::intptr_t /*moved_by*/) {
    MachOFile const file = mach_o_in_memory(header);
    pogosim_program const* program = nullptr;
    std::vector<void (*)()> own;
    for (MachOSection const& section : file.sections) {
        if (section.name == "pogo_program" && section.bytes >= sizeof(program)) {
            program = array_in<pogosim_program const*>(file, header, section).front();
        } else if (section.name == "pogo_own") {
            auto const functions = array_in<void (*)()>(file, header, section);
            own.assign(functions.begin(), functions.end());
        }
    }
    if (program == nullptr) {
        return;
    }
    forget_constructors_of(*program);
    LoadedObject const object = object_with(header);
    std::vector<void (*)()> functions = object.initializers;
    std::erase_if(functions, [&own](auto* const one) { return std::ranges::find(own, one) != own.end(); });
    note_constructors(*program, object, std::move(functions));
}

__attribute__((constructor)) void watch_for_programs() {
    _dyld_register_func_for_add_image(note_loaded);
}

}  // namespace

}  // namespace pogosim

void pogosim_before_constructors(pogosim_program const* /*program*/, void (* /*self*/)()) {}
