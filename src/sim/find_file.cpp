#include "sim/find_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "base/error.hpp"
#include "base/library_folder.hpp"

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

/// The folders in which relative names are searched, in this order; the working folder first.
std::vector<std::filesystem::path> search_folders(Scenario const& scenario) {
    std::vector<std::filesystem::path> folders{""};
    if (!scenario.file.empty()) {
        folders.push_back(scenario.file.parent_path());
    }
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
    std::error_code ignored;
    std::filesystem::path square;
    for (std::filesystem::path const& folder : data_folders()) {
        square = folder / "arenas" / "torus.csv";
        if (std::filesystem::exists(square, ignored)) {
            break;
        }
    }
    return square;
}

std::filesystem::path find_file(Scenario const& scenario, Setting setting, std::string const& name) {
    std::filesystem::path const path(name);
    std::error_code ignored;
    if (path.empty() || (path.is_absolute() && std::filesystem::exists(path, ignored))) {
        return path;
    }
    std::string looked_for;
    if (path.is_relative()) {
        std::vector<std::filesystem::path> const folders = search_folders(scenario);
        for (std::filesystem::path const& folder : folders) {
            if (std::filesystem::exists(folder / path, ignored)) {
                return folder / path;
            }
        }
        if (setting == Setting::arena_file && is_periodic_square(path)) {
            return bundled_periodic_square();
        }
        looked_for = fmt::format("; searched {}", fmt::join(folder_names(folders), ", then in "));
    }
    throw ConfigError(
        fmt::format("{}: there is no file '{}'{}{}", place_of(scenario, setting), name, looked_for,
                    setting == Setting::arena_file ? ". Bundled arenas: arenas/disk.csv, arenas/square.csv, ..." : ""));
}

}  // namespace pogosim
