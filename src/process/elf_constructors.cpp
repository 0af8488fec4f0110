// The static objects of programs on Linux.
#include <link.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "process/constructors.hpp"

namespace pogosim {

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

}  // namespace pogosim

void pogosim_before_constructors(pogosim_program const* program, void (*self)()) {
    using namespace pogosim;
    forget_constructors_of(*program);  // of one that was there before it, and did not fit
    LoadedObject const object = loaded_object_at(program);
    auto const first = std::ranges::find(object.initializers, self);
    if (first != object.initializers.end()) {
        note_constructors(*program, object, {first + 1, object.initializers.end()});
    }
}
