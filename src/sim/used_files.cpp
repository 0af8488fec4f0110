#include "sim/used_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "base/locked_file.hpp"
#include "record/data_file.hpp"
#include "record/message_log.hpp"
#include "render/film_file.hpp"
#include "render/frame_names.hpp"
#include "sim/find_file.hpp"

namespace pogosim {

namespace {

struct UsedFile {
    std::string key;             // empty: the configuration; kVideo: the film
    std::filesystem::path path;  // as the run opens it
    bool is_output = false;
    bool is_beside = false;  // the data file, the message log or the film is put together there
};

constexpr auto kVideo = "--video";

/// Files that this run does not use are omitted.
std::vector<UsedFile> used_files(Scenario const& scenario, std::string const& film) {
    std::vector<UsedFile> files{{"", scenario.file}};
    auto const add_input = [&](std::string const& key, std::string const& name, bool is_used) {
        if (is_used && !name.empty()) {
            files.push_back({key, find_file(scenario, key, name)});
        }
    };
    auto const add_output = [&](std::string const& key, std::string const& name, bool is_used) {
        if (is_used && !name.empty()) {
            files.push_back({key, name, /*is_output=*/true});
        }
    };
    OutputConfig const& output = scenario.output;
    add_input("arena_file", scenario.arena_file, true);
    add_input("formation_filename", scenario.formation.filename, scenario.formation.name == kImportedFormation);
    add_output("data_filename", output.data_filename, output.enable_data_logging);
    add_output("console_filename", output.console_filename, output.enable_console_logging);
    add_output("message_log", output.message_log, true);
    add_output(kVideo, film, true);
    if (output.enable_data_logging && !output.data_filename.empty()) {
        files.push_back(
            {"data_filename", DataFile::path_beside(output.data_filename), /*is_output=*/true, /*is_beside=*/true});
    }
    if (!output.message_log.empty()) {
        files.push_back(
            {"message_log", MessageLog::path_beside(output.message_log), /*is_output=*/true, /*is_beside=*/true});
    }
    if (!film.empty()) {
        files.push_back({kVideo, FilmFile::path_beside(film), /*is_output=*/true, /*is_beside=*/true});
    }
    return files;
}

/// A device may well be used twice: /dev/stdin and /dev/stdout are one terminal.
bool are_same(std::filesystem::path const& a, std::filesystem::path const& b) {
    std::error_code error;
    bool const both_exist = std::filesystem::exists(a, error) && std::filesystem::exists(b, error);
    if (both_exist) {
        return std::filesystem::is_regular_file(a, error) && std::filesystem::equivalent(a, b, error);
    }
    return real_path(a) == real_path(b);
}

/// "file:line: key: " for messages.
std::string where_it_is_named(Scenario const& scenario, std::string const& key) {
    return key == kVideo ? fmt::format("{}: ", key) : fmt::format("{}: {}: ", where_at_top(scenario, key), key);
}

std::string described(Scenario const& scenario, UsedFile const& file) {
    if (file.key.empty()) {
        return fmt::format("the configuration file '{}'", file.path.string());
    }
    return file.key == kVideo
               ? fmt::format("the film '{}' (--video)", file.path.string())
               : fmt::format("{} '{}' ({})", file.key, file.path.string(), where_at_top(scenario, file.key));
}

char const* fate(UsedFile const& file) {
    return file.is_output ? "which the run also writes" : "which the run would overwrite";
}

char const* purpose_of_file_beside(UsedFile const& file) {
    if (!file.is_beside) {
        return "";
    }
    if (file.key == "message_log") {
        return " (used to assemble the message log)";
    }
    return file.key == kVideo ? " (used to assemble the film)" : " (used to assemble the data file)";
}

void check_frames_name(Scenario const& scenario, std::vector<UsedFile> const& files) {
    if (scenario.view.save_video_period_s <= 0.0) {
        return;
    }
    FrameNames const names(scenario.view.frames_name);
    auto const same = std::ranges::find_if(files, [&](UsedFile const& file) { return names.may_be(file.path); });
    if (same != files.end()) {
        throw ConfigError(fmt::format("{}a frame may be the same file as {}, {}; choose another name",
                                      where_it_is_named(scenario, "frames_name"), described(scenario, *same),
                                      fate(*same)));
    }
}

}  // namespace

void check_used_files(Scenario const& scenario, std::string const& film) {
    std::vector<UsedFile> const files = used_files(scenario, film);
    for (std::size_t i = 0; i < files.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            UsedFile const& written = files[i];
            UsedFile const& other = files[j];
            if (written.is_output && written.key != other.key && are_same(written.path, other.path)) {
                throw ConfigError(fmt::format("{}'{}'{} is the same file as {}, {}; choose another file",
                                              where_it_is_named(scenario, written.key), written.path.string(),
                                              purpose_of_file_beside(written), described(scenario, other),
                                              fate(other)));
            }
        }
    }
    check_frames_name(scenario, files);
}

bool is_used_file(Scenario const& scenario, std::string const& film, std::filesystem::path const& path) {
    return std::ranges::any_of(used_files(scenario, film),
                               [&path](UsedFile const& file) { return are_same(file.path, path); });
}

}  // namespace pogosim
