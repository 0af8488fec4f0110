#include "config/find_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <vector>

#include "base/error.hpp"
#include "base/library_folder.hpp"
#include "config/looked_up.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

/// Folders with the bundled arenas: of the installed library, and of the sources.
std::vector<std::filesystem::path> data_folders() {
    std::vector<std::filesystem::path> folders;
    if (std::filesystem::path const library = library_folder(); !library.empty()) {
        folders.push_back(library / POGOSIM_DATA_FROM_LIBRARY);
    }
    if (std::filesystem::path sources = POGOSIM_SOURCE_DATA_DIR; !sources.empty()) {
        folders.push_back(std::move(sources));
    }
    return folders;
}

/// The folders of POGOSIM_PATH, in which other packages have robot models and arenas.
std::vector<std::filesystem::path> folders_of_user() {
    std::vector<std::filesystem::path> folders;
    char const* const list = std::getenv("POGOSIM_PATH");
    std::istringstream names(list == nullptr ? "" : list);
    for (std::string name; std::getline(names, name, ':');) {
        if (!name.empty()) {
            folders.emplace_back(name);
        }
    }
    return folders;
}

/// The folders in which relative names are searched, in this order; the working folder first.
std::vector<std::filesystem::path> search_folders(std::filesystem::path const& configuration) {
    std::vector<std::filesystem::path> folders{""};
    if (!configuration.empty()) {
        folders.push_back(configuration.parent_path());
    }
    std::ranges::move(folders_of_user(), std::back_inserter(folders));
    std::ranges::move(data_folders(), std::back_inserter(folders));
    return folders;
}

/// The folders as absolute paths, each once.
std::vector<std::string> folder_names(std::vector<std::filesystem::path> const& folders) {
    std::vector<std::string> names;
    for (std::filesystem::path const& folder : folders) {
        std::error_code ignored;
        std::filesystem::path const full = std::filesystem::weakly_canonical(
            folder.empty() ? std::filesystem::current_path(ignored) : folder, ignored);
        std::string name = full.string();
        if (std::filesystem::is_directory(full, ignored) && std::ranges::find(names, name) == names.end()) {
            names.push_back(std::move(name));
        }
    }
    return names;
}

}  // namespace

bool is_periodic_square(std::filesystem::path const& name) {
    return name.filename() == "torus.csv" || name.filename() == "empty.csv";
}

std::filesystem::path bundled_periodic_square() {
    std::filesystem::path square;
    for (std::filesystem::path const& folder : data_folders()) {
        square = folder / "arenas" / "torus.csv";
        if (look_for(square)) {
            break;
        }
    }
    return square;
}

FoundFile search_file(std::filesystem::path const& configuration, std::string const& name) {
    std::filesystem::path const path(name);
    if (path.is_absolute()) {
        return {look_for(path) ? path : "", ""};
    }
    std::vector<std::filesystem::path> const folders = search_folders(configuration);
    for (std::filesystem::path const& folder : folders) {
        if (look_for(folder / path)) {
            return {folder / path, ""};
        }
    }
    return {"", fmt::format("; searched {}", fmt::join(folder_names(folders), ", then in "))};
}

std::filesystem::path find_file(Place const& place, std::filesystem::path const& configuration,
                                std::string_view expected, std::string_view hint) {
    std::string const& name = place.node.scalar;
    FoundFile found = search_file(configuration, name);
    if (name.empty() || found.path.empty()) {
        fail_at(place, fmt::format("there is no file '{}'{}{}", shown(name), found.searched, hint));
    }
    if (look_for_folder(found.path)) {
        fail_at(place, fmt::format("'{}' is a folder; expected {}", shown(name), expected));
    }
    return std::move(found.path);
}

std::filesystem::path find_file(Scenario const& scenario, Setting setting, std::string const& name) {
    if (name.empty()) {
        return {};
    }
    FoundFile found = search_file(scenario.file, name);
    bool const is_arena = setting == Setting::arena_file;
    if (found.path.empty() && is_arena && !found.searched.empty() && is_periodic_square(name)) {
        return bundled_periodic_square();
    }
    if (found.path.empty()) {
        throw ConfigError(fmt::format("{}: there is no file '{}'{}{}", place_of(scenario, setting), shown(name),
                                      found.searched,
                                      is_arena ? ". Bundled arenas: arenas/disk.csv, arenas/square.csv, ..." : ""));
    }
    if (look_for_folder(found.path)) {
        throw ConfigError(
            fmt::format("{}: '{}' is a folder; expected a file", place_of(scenario, setting), shown(name)));
    }
    return found.path;
}

}  // namespace pogosim
