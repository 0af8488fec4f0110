#include "record/tables_module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <stdexcept>

#include "base/error.hpp"
#include "base/library_folder.hpp"
#include "base/memory.hpp"
#include "base/scratch_file.hpp"

namespace pogosim {

namespace {

constinit GetTablesModule linked = nullptr;

/// Where memory runs out while Arrow is loaded, the constructors of its static objects are not all done, and at the end
/// of the process its destructors crash. So it is not loaded with less address space than that takes.
void require_memory() {
    constexpr std::size_t kMebibytes = 80;
    constexpr std::size_t kBytes = kMebibytes << 20U;
    void* const place = mmap(nullptr, kBytes, PROT_NONE, MAP_PRIVATE | MAP_ANON, -1, 0);
    if (place == MAP_FAILED) {
        throw OutOfMemory(fmt::format(
            "not enough memory for the library that writes and reads rows (Apache Arrow), {} MiB; do without "
            "(enable_data_logging: false), or raise this run's memory limit (ulimit -v, or the batch system's)",
            kMebibytes));
    }
    munmap(place, kBytes);
}

GetTablesModule load_module() {
    require_memory();
    std::string const path = (library_folder() / kTablesModuleFile).string();  // where it is built, and where installed
    void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
        throw std::runtime_error(fmt::format("the module of data files cannot be loaded: {}", dlerror()));
    }
    auto const get = reinterpret_cast<GetTablesModule>(dlsym(module, kGetTablesModuleName));
    if (get == nullptr) {
        throw std::runtime_error(fmt::format("{} is no module of Pogosim", path));
    }
    return get;
}

}  // namespace

void link_tables_module(GetTablesModule get_module) {
    linked = get_module;
}

TablesModule const& tables_module() {
    static TablesModule const* const module = (linked != nullptr ? linked : load_module())(
        {.scratch_files = scratch_files_of_process(), .save_progress = &save_progress()});
    return *module;
}

TablesModule const& tables_module_to_write(char const* what, std::string const& path, char const* key) {
    try {
        return tables_module();
    } catch (OutOfMemory const&) {
        throw;
    } catch (std::runtime_error const& error) {
        throw OutputError(fmt::format("cannot write the {} '{}' ({}): {}", what, path, key, error.what()));
    }
}

void throw_if_failed(TablesCall const& call) {
    switch (call.error) {
        case TablesCall::Error::none:
            return;
        case TablesCall::Error::config:
            throw ConfigError(call.what);
        case TablesCall::Error::output:
            throw OutputError(call.what);
        case TablesCall::Error::memory:
            throw std::bad_alloc();
        case TablesCall::Error::other:
            throw std::runtime_error(call.what);
    }
}

}  // namespace pogosim
