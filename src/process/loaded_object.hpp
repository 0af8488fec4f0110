// The executables and shared objects that are in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pogosim {

struct LoadedObject {
    std::uintptr_t load_address = 0;  // of what its file says
    std::vector<std::span<std::byte>> writable{};
    std::span<void (*const)()> initializers{};  // called before main(), or when it was loaded
};

/// The object that contains a place in memory. Empty if that is not known, as on systems other than Linux.
LoadedObject loaded_object_at(void const* place);

}  // namespace pogosim
