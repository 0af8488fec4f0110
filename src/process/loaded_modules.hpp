// The executable and the libraries in this process, by which one process finds again what another one has noted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pogosim {

struct LoadedModule {
    std::string name;  // of its file, without folders; of the executable: empty
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
    std::string build;  // which of the files with this name it is: the build id, or where there is none, its size
};

/// All of this process.
std::vector<LoadedModule> loaded_modules();

/// The one that contains a place; null: none does.
LoadedModule const* module_at(std::vector<LoadedModule> const& modules, void const* place);

/// A piece of the address space: code, a heap, a stack and so on.
struct MappedMemory {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
    bool is_heap = false;
};

/// All pieces of this process, in order.
std::vector<MappedMemory> mapped_memory();

}  // namespace pogosim
