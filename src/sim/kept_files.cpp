#include "sim/kept_files.hpp"

#include <fmt/format.h>

#include <optional>
#include <system_error>

#include "base/locked_file.hpp"
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

/// Calls take(name) for numbered names, until one is taken.
template <class Take>
std::optional<fs::path> first_taken(fs::path const& path, bool is_folder, Take const& take) {
    for (int number = 1; number < kMostNumbers; ++number) {
        fs::path const name = numbered(path, number, is_folder);
        std::error_code error;
        if (!fs::exists(fs::symlink_status(name, error))) {
            if (take(name)) {
                return name;
            }
            if (!fs::exists(fs::symlink_status(name, error))) {
                return std::nullopt;  // for another reason than a faster run
            }
        }
    }
    return std::nullopt;
}

std::optional<fs::path> free_name(fs::path const& path, bool is_folder) {
    return first_taken(path, is_folder, [](fs::path const&) { return true; });
}

/// Where they really are, so that symbolic links go on leading there.
std::vector<fs::path> single_files(Scenario const& scenario, std::string const& film) {
    OutputConfig const& output = scenario.output;
    std::vector<fs::path> files;
    for (std::string const& name : {output.enable_data_logging ? output.data_filename : "", output.message_log, film}) {
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

std::optional<fs::path> keep_file(fs::path const& path) {
    try {
        LockedFile const lock(path);  // no other run is writing it
        return first_taken(path, /*is_folder=*/false, [&](fs::path const& name) {
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
    } catch (FileError const&) {
        return std::nullopt;
    }
}

}  // namespace

std::vector<KeptFile> earlier_files(Scenario const& scenario, std::string const& film) {
    std::vector<KeptFile> files;
    for (fs::path const& path : single_files(scenario, film)) {
        if (auto const name = free_name(path, /*is_folder=*/false)) {
            files.push_back({path, *name});
        }
    }
    Frames const frames = frames_of(scenario);
    if (auto const name = frames.files.empty() ? std::nullopt : free_name(frames.folder, /*is_folder=*/true)) {
        files.push_back({frames.folder, *name});
    }
    return files;
}

std::vector<KeptFile> keep_earlier_files(Scenario const& scenario, std::string const& film) {
    std::vector<KeptFile> files;
    for (fs::path const& path : single_files(scenario, film)) {
        if (auto const name = keep_file(path)) {
            files.push_back({path, *name});
        }
    }
    Frames const frames = frames_of(scenario);
    if (auto const name = frames.files.empty() ? std::nullopt : keep_frames(frames)) {
        files.push_back({frames.folder, *name});
    }
    return files;
}

}  // namespace pogosim
