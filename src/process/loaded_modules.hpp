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

/// All of this process. Empty on systems other than Linux.
std::vector<LoadedModule> loaded_modules();

/// The one that contains a place; null: none does.
LoadedModule const* module_at(std::vector<LoadedModule> const& modules, void const* place);

/// Other memory of this process: its heap, stacks and so on. Neighbours may be in one piece.
struct MappedMemory {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
};
std::vector<MappedMemory> mapped_memory();

}  // namespace pogosim
