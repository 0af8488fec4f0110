#include "process/loaded_object.hpp"

#ifdef __linux__
#include <link.h>

#include <algorithm>
#endif

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

std::span<void (*const)()> initializers_of(dl_phdr_info const& object, ElfW(Dyn) const* entry) {
    std::uintptr_t place = 0;
    std::size_t bytes = 0;
    for (; entry->d_tag != DT_NULL; ++entry) {
        place = entry->d_tag == DT_INIT_ARRAY ? object.dlpi_addr + entry->d_un.d_ptr : place;
        bytes = entry->d_tag == DT_INIT_ARRAYSZ ? entry->d_un.d_val : bytes;
    }
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
    return {reinterpret_cast<void (*const*)()>(place), bytes / sizeof(void (*)())};
}

int look_at_object(dl_phdr_info* object, std::size_t /*bytes*/, void* of_search) {
    auto& search = *static_cast<Search*>(of_search);
    if (!contains(*object, search.place)) {
        return 0;
    }
    search.found.load_address = object->dlpi_addr;
    for (auto const& segment : std::span(object->dlpi_phdr, object->dlpi_phnum)) {
        // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
        auto* const begin = reinterpret_cast<std::byte*>(object->dlpi_addr + segment.p_vaddr);
        if (segment.p_type == PT_DYNAMIC) {
            search.found.initializers = initializers_of(*object, reinterpret_cast<ElfW(Dyn) const*>(begin));
        } else if (segment.p_type == PT_LOAD && (segment.p_flags & PF_W) != 0) {
            search.found.writable.emplace_back(begin, segment.p_memsz);
        }
    }
    return 1;
}

}  // namespace

LoadedObject loaded_object_at(void const* place) {
    Search search{.place = reinterpret_cast<std::uintptr_t>(place)};
    dl_iterate_phdr(look_at_object, &search);
    return search.found;
}

#else

LoadedObject loaded_object_at(void const* /*place*/) {
    return {};
}

#endif

}  // namespace pogosim
