#include "sim/data_files.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <vector>

#include "base/error.hpp"

namespace pogosim {

namespace {

/// Folders with the arenas that come along: of the installed library, wherever it has been moved to, and of the
/// sources.
std::vector<std::filesystem::path> data_folders() {
    std::vector<std::filesystem::path> folders;
    Dl_info library = {};
    if (dladdr(reinterpret_cast<void const*>(&find_file), &library) != 0 && library.dli_fname != nullptr) {
        std::filesystem::path const folder = std::filesystem::path(library.dli_fname).parent_path();
        folders.push_back(folder / POGOSIM_DATA_FROM_LIBRARY);
    }
    folders.emplace_back(POGOSIM_SOURCE_DATA_DIR);
    return folders;
}

}  // namespace

std::filesystem::path find_file(Scenario const& scenario, std::string const& key, std::string const& name) {
    std::filesystem::path path(name);
    std::error_code ignored;
    if (path.empty() || std::filesystem::exists(path, ignored)) {
        return path;
    }
    if (path.is_relative()) {
        for (std::filesystem::path const& folder : data_folders()) {
            if (std::filesystem::exists(folder / path, ignored)) {
                return folder / path;
            }
        }
    }
    throw ConfigError(
        fmt::format("{}: {}: there is no file '{}'; it is looked for from the working folder ({}), then in the "
                    "folder of Pogosim{}",
                    where_at_top(scenario, key), key, name, std::filesystem::current_path(ignored).string(),
                    key == "arena_file" ? ". Arenas that come along: arenas/disk.csv, arenas/square.csv, ..." : ""));
}

}  // namespace pogosim
