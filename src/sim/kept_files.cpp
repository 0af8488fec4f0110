#include "sim/kept_files.hpp"

#include <fmt/format.h>

#include <optional>
#include <system_error>

#include "base/error.hpp"
#include "base/locked_file.hpp"
#include "record/paths_beside.hpp"
#include "render/frame_names.hpp"

namespace pogosim {

namespace {

namespace fs = std::filesystem;

constexpr int kMostNumbers = 1000000;

/// "run.1.feather" for "run.feather"; a folder gets its number at the end.
fs::path numbered(fs::path const& path, int number, bool is_folder) {
    std::string const extension = is_folder ? "" : path.extension().string();
    std::string const stem = is_folder ? path.filename().string() : path.stem().string();
    return path.parent_path() / fmt::format("{}.{}{}", stem, number, extension);
}

/// True if there is no such file, nor the metadata of one (of a CSV file).
bool is_free(fs::path const& name) {
    std::error_code error;
    std::optional<fs::path> const metadata = metadata_beside(name.string());
    return !fs::exists(fs::symlink_status(name, error)) &&
           !(metadata && fs::exists(fs::symlink_status(*metadata, error)));
}

/// Calls take(name) for numbered names, until one is taken.
template <class Take>
std::optional<fs::path> first_taken(fs::path const& path, bool is_folder, Take const& take) {
    for (int number = 1; number < kMostNumbers; ++number) {
        fs::path const name = numbered(path, number, is_folder);
        if (is_free(name)) {
            if (take(name)) {
                return name;
            }
            if (is_free(name)) {
                return std::nullopt;  // it failed, and not because another run took the name
            }
        }
    }
    return std::nullopt;
}

std::optional<fs::path> free_name(fs::path const& path, bool is_folder) {
    return first_taken(path, is_folder, [](fs::path const&) { return true; });
}

/// The archive of flash memory that the run writes; empty if it is its input, too.
std::string own_archive(FlashStateConfig const& files) {
    bool const is_input = !files.input_file.empty() && real_path(files.input_file) == real_path(files.output_file);
    return is_input ? "" : files.output_file;
}

/// Resolves symbolic links, so that they still lead to the new files.
std::vector<fs::path> single_files(Scenario const& scenario, std::string const& film) {
    OutputConfig const& output = scenario.output;
    std::vector<fs::path> files;
    for (std::string const& name : {output.enable_data_logging ? output.data_filename : "", output.message_log, film,
                                    own_archive(scenario.flash_state)}) {
        std::error_code error;
        fs::path const path = name.empty() ? fs::path() : real_path(name);
        if (!name.empty() && fs::is_regular_file(path, error) && fs::file_size(path, error) > 0) {
            files.push_back(path);
        }
    }
    return files;
}

struct Frames {
    fs::path folder;
    std::vector<fs::path> files;
};

Frames frames_of(Scenario const& scenario) {
    Frames frames;
    FrameNames const names(scenario.view.frames_name);
    std::optional<fs::path> const folder = names.folder();
    if (scenario.view.save_video_period_s <= 0.0 || !folder) {
        return frames;
    }
    frames.folder = *folder == "." ? fs::path("frames") : *folder;
    std::error_code error;
    for (auto entry = fs::directory_iterator(*folder, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        if (names.may_be(entry->path())) {
            frames.files.push_back(entry->path());
        }
    }
    return frames;
}

std::optional<fs::path> keep_frames(Frames const& frames) {
    auto const kept = first_taken(frames.folder, /*is_folder=*/true, [](fs::path const& folder) {
        std::error_code error;
        return fs::create_directory(folder, error);
    });
    for (fs::path const& file : frames.files) {
        std::error_code error;
        if (kept) {
            fs::rename(file, *kept / file.filename(), error);
        }
    }
    return kept;
}

/// The metadata of a CSV file go with it.
void keep_metadata(fs::path const& path, fs::path const& name) {
    std::error_code error;
    std::optional<fs::path> const metadata = metadata_beside(path.string());
    if (metadata && fs::exists(*metadata, error)) {
        fs::rename(*metadata, *metadata_beside(name.string()), error);
    }
}

std::optional<fs::path> keep_file(fs::path const& path) {
    try {
        LockedFile const lock(path);  // no other run is writing it
        auto const kept = first_taken(path, /*is_folder=*/false, [&](fs::path const& name) {
            // A link never replaces a file that another process has made in the meantime. Some file systems have none.
            std::error_code error;
            fs::create_hard_link(path, name, error);
            if (!error) {
                fs::remove(path, error);
                return true;
            }
            if (error == std::errc::file_exists) {
                return false;
            }
            fs::rename(path, name, error);
            return !error;
        });
        if (kept) {
            keep_metadata(path, *kept);
        }
        return kept;
    } catch (FileError const&) {
        return std::nullopt;
    }
}

}  // namespace

std::vector<KeptFile> earlier_files(Scenario const& scenario, std::string const& film) {
    std::vector<KeptFile> files;
    for (fs::path const& path : single_files(scenario, film)) {
        if (auto const name = free_name(path, /*is_folder=*/false)) {
            files.push_back({.path = path, .kept = *name});
        }
    }
    Frames const frames = frames_of(scenario);
    if (auto const name = frames.files.empty() ? std::nullopt : free_name(frames.folder, /*is_folder=*/true)) {
        files.push_back({.path = frames.folder, .kept = *name});
    }
    return files;
}

std::vector<KeptFile> keep_earlier_files(Scenario const& scenario, std::string const& film) {
    std::vector<KeptFile> files;
    for (fs::path const& path : single_files(scenario, film)) {
        if (auto const name = keep_file(path)) {
            files.push_back({.path = path, .kept = *name});
        }
    }
    Frames const frames = frames_of(scenario);
    if (auto const name = frames.files.empty() ? std::nullopt : keep_frames(frames)) {
        files.push_back({.path = frames.folder, .kept = *name, .moved = frames.files});
    }
    return files;
}

std::vector<KeptFile> keep_earlier_part(Scenario const& scenario, std::string const& film) {
    std::vector<KeptFile> files;
    for (fs::path const& path : single_files(scenario, film)) {
        auto const name = keep_file(path);
        if (!name) {
            give_back(files);
            throw OutputError(fmt::format(
                "--from-state: '{}' of the earlier part cannot be renamed, and would be lost: another run is "
                "writing it, or this folder cannot be changed",
                path.string()));
        }
        files.push_back({.path = path, .kept = *name});
    }
    return files;
}

void give_back(std::vector<KeptFile> const& files) {
    for (KeptFile const& file : files) {
        std::error_code error;
        for (fs::path const& frame : file.moved) {
            if (is_free(frame)) {
                fs::rename(file.kept / frame.filename(), frame, error);
            }
        }
        if (!file.moved.empty()) {
            fs::remove(file.kept, error);  // if it is empty
        } else if (is_free(file.path)) {
            fs::rename(file.kept, file.path, error);
            keep_metadata(file.kept, file.path);
        }
    }
}

}  // namespace pogosim
