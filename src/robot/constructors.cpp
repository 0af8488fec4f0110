#include "robot/constructors.hpp"

#include <dlfcn.h>
#ifdef __linux__
#include <link.h>
#endif

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>

#include "robot/context.hpp"
#include "robot/robot_memory.hpp"

namespace pogosim {

namespace {

// By program. Needed before the constructors of this library's own objects are certain to have run.
struct Noted {
    std::mutex mutex;
    std::map<pogosim_program const*, std::shared_ptr<Constructors const>> of_program;
};
Noted& noted() {
    static auto* const all = new Noted();  // programs may be loaded until the process ends
    return *all;
}

#ifdef __linux__

struct Search {
    std::uintptr_t program;
    void (*first)();
    Constructors found{};
};

/// Those after `first`. The last of them may be the compiler's own, which does nothing.
std::vector<void (*)()> functions_after(void (*first)(), dl_phdr_info const& object, ElfW(Dyn) const* entry) {
    std::uintptr_t place = 0;
    std::size_t bytes = 0;
    for (; entry->d_tag != DT_NULL; ++entry) {
        place = entry->d_tag == DT_INIT_ARRAY ? object.dlpi_addr + entry->d_un.d_ptr : place;
        bytes = entry->d_tag == DT_INIT_ARRAYSZ ? entry->d_un.d_val : bytes;
    }
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
    std::span const all(reinterpret_cast<void (*const*)()>(place), bytes / sizeof(first));
    auto const self = std::ranges::find(all, first);
    return self == all.end() ? std::vector<void (*)()>() : std::vector<void (*)()>(self + 1, all.end());
}

int look_at_object(dl_phdr_info* object, std::size_t /*bytes*/, void* of_search) {
    auto& search = *static_cast<Search*>(of_search);
    std::span const segments(object->dlpi_phdr, object->dlpi_phnum);
    bool const contains_program = std::ranges::any_of(segments, [&](auto const& segment) {
        std::uintptr_t const begin = object->dlpi_addr + segment.p_vaddr;
        return segment.p_type == PT_LOAD && search.program >= begin && search.program - begin < segment.p_memsz;
    });
    if (!contains_program) {
        return 0;
    }
    for (auto const& segment : segments) {
        // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
        auto* const place = reinterpret_cast<std::byte*>(object->dlpi_addr + segment.p_vaddr);
        if (segment.p_type == PT_DYNAMIC) {
            search.found.functions = functions_after(search.first, *object, reinterpret_cast<ElfW(Dyn) const*>(place));
        } else if (segment.p_type == PT_LOAD && (segment.p_flags & PF_W) != 0) {
            search.found.before.push_back({.place = place, .bytes = std::vector<std::byte>(segment.p_memsz)});
        }
    }
    return 1;
}

#endif

}  // namespace

std::shared_ptr<Constructors const> constructors_of(pogosim_program const& program) {
    std::lock_guard const lock(noted().mutex);
    auto const place = noted().of_program.find(&program);
    return place == noted().of_program.end() ? nullptr : place->second;
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

}  // namespace pogosim

void pogosim_before_constructors([[maybe_unused]] pogosim_program const* program, [[maybe_unused]] void (*self)()) {
#ifdef __linux__
    using namespace pogosim;
    constexpr std::size_t kCompilersOwn = 1;
    Search search{.program = reinterpret_cast<std::uintptr_t>(program), .first = self};
    dl_iterate_phdr(look_at_object, &search);
    std::lock_guard const lock(noted().mutex);
    noted().of_program.erase(program);  // of one that was there before it
    if (search.found.functions.size() <= kCompilersOwn) {
        return;
    }
    for (Constructors::Piece& piece : search.found.before) {
        copy_program_bytes(piece.bytes.data(), piece.place, piece.bytes.size());
    }
    noted().of_program.emplace(program, std::make_shared<Constructors const>(std::move(search.found)));
#endif
}

int pogosim_at_end(void (*destroy)(void*), void* object, void* library) {
    // A robot's program does not end, and its objects are no longer in place when the process does.
    if (pogosim::context.controller != nullptr && pogosim::context.has_own_memory) {
        return 0;
    }
    // By its name: in an executable that contains this, the program's own one, which calls this, would be meant.
    using AtEnd = int (*)(void (*)(void*), void*, void*);
    static auto const of_library = reinterpret_cast<AtEnd>(dlsym(RTLD_DEFAULT, "__cxa_atexit"));
    return of_library(destroy, object, library);
}
