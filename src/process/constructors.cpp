#include "process/constructors.hpp"

#ifdef __linux__
#include <link.h>
#include <unistd.h>
#else
#include <dlfcn.h>
#include <mach-o/dyld.h>
#endif

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#ifndef __linux__
#include "process/mach_o_file.hpp"
#endif
#include "process/program_memory.hpp"

namespace pogosim {

#ifdef __linux__

namespace {

struct Search {
    std::uintptr_t place;
    LoadedObject found{};
};

bool contains(dl_phdr_info const& object, std::uintptr_t place) {
    std::span const segments(object.dlpi_phdr, object.dlpi_phnum);
    return std::ranges::any_of(segments, [&](auto const& segment) {
        std::uintptr_t const begin = object.dlpi_addr + segment.p_vaddr;
        return segment.p_type == PT_LOAD && place >= begin && place - begin < segment.p_memsz;
    });
}

/// The functions of an array that entries of these kinds describe: its place and its size.
std::vector<void (*)()> functions_of(dl_phdr_info const& object, ElfW(Dyn) const* entry,
                                     decltype(entry->d_tag) of_place, decltype(entry->d_tag) of_size) {
    std::uintptr_t place = 0;
    std::size_t bytes = 0;
    for (; entry->d_tag != DT_NULL; ++entry) {
        place = entry->d_tag == of_place ? object.dlpi_addr + entry->d_un.d_ptr : place;
        bytes = entry->d_tag == of_size ? entry->d_un.d_val : bytes;
    }
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
    std::span const functions(reinterpret_cast<void (*const*)()>(place), bytes / sizeof(void (*)()));
    return {functions.begin(), functions.end()};
}

/// Takes what the loader has made read-only after its start (RELRO: whole pages) off the memory that can be written.
void cut_off(std::vector<std::span<std::byte>>& writable, std::byte* place, std::size_t bytes) {
    auto const page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    auto const begin = reinterpret_cast<std::uintptr_t>(place) / page * page;
    auto const end = (reinterpret_cast<std::uintptr_t>(place) + bytes) / page * page;
    std::vector<std::span<std::byte>> rest;
    for (std::span<std::byte> const piece : writable) {
        auto const first = reinterpret_cast<std::uintptr_t>(piece.data());
        std::size_t const before = std::min<std::size_t>(begin - std::min(begin, first), piece.size());
        std::size_t const up_to = std::min<std::size_t>(end - std::min(end, first), piece.size());
        for (std::span<std::byte> const left : {piece.first(before), piece.subspan(std::max(before, up_to))}) {
            if (!left.empty()) {
                rest.push_back(left);
            }
        }
    }
    writable = std::move(rest);
}

int look_at_object(dl_phdr_info* object, std::size_t /*bytes*/, void* of_search) {
    auto& search = *static_cast<Search*>(of_search);
    if (!contains(*object, search.place)) {
        return 0;
    }
    search.found.load_address = object->dlpi_addr;
    std::span<std::byte> read_only;
    for (auto const& segment : std::span(object->dlpi_phdr, object->dlpi_phnum)) {
        // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
        auto* const begin = reinterpret_cast<std::byte*>(object->dlpi_addr + segment.p_vaddr);
        if (segment.p_type == PT_DYNAMIC) {
            auto const* const entries = reinterpret_cast<ElfW(Dyn) const*>(begin);
            search.found.initializers = functions_of(*object, entries, DT_INIT_ARRAY, DT_INIT_ARRAYSZ);
            search.found.finalizers = functions_of(*object, entries, DT_FINI_ARRAY, DT_FINI_ARRAYSZ);
        } else if (segment.p_type == PT_LOAD && (segment.p_flags & PF_W) != 0) {
            search.found.writable.emplace_back(begin, segment.p_memsz);
        } else if (segment.p_type == PT_GNU_RELRO) {
            read_only = {begin, segment.p_memsz};
        }
    }
    cut_off(search.found.writable, read_only.data(), read_only.size());
    return 1;
}

}  // namespace

LoadedObject loaded_object_at(void const* place) {
    Search search{.place = reinterpret_cast<std::uintptr_t>(place)};
    dl_iterate_phdr(look_at_object, &search);
    return search.found;
}

#else

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

#endif

namespace {

// One entry for each program. Allocated on first use, which may come before the static objects of this library are
// constructed.
struct Noted {
    std::mutex mutex;
    std::map<pogosim_program const*, std::shared_ptr<Constructors const>> of_program;
};
Noted& noted() {
    static auto* const all = new Noted();  // programs may be loaded until the process ends
    return *all;
}

}  // namespace

std::shared_ptr<Constructors const> constructors_of(pogosim_program const& program) {
    std::lock_guard const lock(noted().mutex);
    auto const place = noted().of_program.find(&program);
    return place == noted().of_program.end() ? nullptr : place->second;
}

void forget_constructors_of(pogosim_program const& program) {
    std::lock_guard const lock(noted().mutex);
    noted().of_program.erase(&program);
}

void construct_again(Constructors const& constructors, std::span<std::span<std::byte> const> pieces) {
    for (Constructors::Piece const& piece : constructors.before) {
        for (std::span<std::byte> const variables : pieces) {
            if (variables.data() >= piece.place && variables.data() < piece.place + piece.bytes.size()) {
                copy_program_bytes(variables.data(), piece.bytes.data() + (variables.data() - piece.place),
                                   variables.size());
            }
        }
    }
    for (void (*const construct)() : constructors.functions) {
        construct();
    }
}

namespace {

/// Notes that these functions of a program are about to run.
void note(pogosim_program const& program, LoadedObject const& object, std::vector<void (*)()> functions) {
    if (functions.size() <= kFunctionsOfCompiler) {
        return;
    }
    Constructors constructors{.before = {}, .functions = std::move(functions)};
    for (std::span<std::byte> const piece : object.writable) {
        Constructors::Piece kept{.place = piece.data(), .bytes = std::vector<std::byte>(piece.size())};
        copy_program_bytes(kept.bytes.data(), kept.place, kept.bytes.size());
        constructors.before.push_back(std::move(kept));
    }
    std::lock_guard const lock(noted().mutex);
    noted().of_program[&program] = std::make_shared<Constructors const>(std::move(constructors));
}

#ifdef __APPLE__

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
    note(*program, object, std::move(functions));
}

__attribute__((constructor)) void watch_for_programs() {
    _dyld_register_func_for_add_image(note_loaded);
}

#endif

}  // namespace

}  // namespace pogosim

#ifdef __APPLE__

void pogosim_before_constructors(pogosim_program const* /*program*/, void (* /*self*/)()) {}

#else

void pogosim_before_constructors(pogosim_program const* program, void (*self)()) {
    using namespace pogosim;
    forget_constructors_of(*program);  // of one that was there before it, and did not fit
    LoadedObject const object = loaded_object_at(program);
    auto const first = std::ranges::find(object.initializers, self);
    if (first != object.initializers.end()) {
        note(*program, object, {first + 1, object.initializers.end()});
    }
}

#endif
