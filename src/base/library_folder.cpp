#include "base/library_folder.hpp"

#include <dlfcn.h>

namespace pogosim {

std::filesystem::path library_folder() {
    Dl_info library = {};
    if (dladdr(reinterpret_cast<void const*>(&library_folder), &library) == 0 || library.dli_fname == nullptr) {
        return {};
    }
    return std::filesystem::path(library.dli_fname).parent_path();
}

}  // namespace pogosim
