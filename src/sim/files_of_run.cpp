#include "sim/files_of_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "base/locked_file.hpp"
#include "base/table_format.hpp"
#include "config/find_file.hpp"
#include "config/places.hpp"
#include "record/paths_beside.hpp"
#include "render/film_file.hpp"
#include "render/frame_names.hpp"
#include "sim/flash_state.hpp"
#include "sim/pictures.hpp"

namespace pogosim {

namespace {

struct UsedFile {
    std::optional<Setting> setting;  // empty: the configuration, or the film
    std::filesystem::path path;      // as the run opens it
    bool is_output = false;          // without a setting: the film
    char const* purpose = "";        // of a file beside an output; of an input without a setting, what it is
};

/// Files that this run does not use are omitted.
std::vector<UsedFile> used_files(Scenario const& scenario, std::string const& film) {
    std::vector<UsedFile> files{{std::nullopt, scenario.file, /*is_output=*/false, "the configuration file"}};
    for (auto const& [path, what] : scenario.object_files) {
        files.push_back({std::nullopt, path, /*is_output=*/false, what});
    }
    auto const add_input = [&](Setting setting, std::string const& name, bool is_used) {
        if (is_used && !name.empty()) {
            files.push_back({setting, find_file(scenario, setting, name)});
        }
    };
    auto const add_output = [&](std::optional<Setting> setting, std::string const& name, bool is_used) {
        if (is_used && !name.empty()) {
            files.push_back({setting, name, /*is_output=*/true});
        }
    };
    auto const add_beside = [&](std::optional<Setting> setting, std::optional<std::filesystem::path> const& path,
                                char const* purpose) {
        if (path) {
            files.push_back({setting, *path, /*is_output=*/true, purpose});
        }
    };
    OutputConfig const& output = scenario.output;
    add_input(Setting::arena_file, scenario.arena_file, true);
    add_input(Setting::formation_filename, scenario.formation.filename, scenario.formation.name == kImportedFormation);
    add_input(Setting::magnetometer_table, scenario.magnetometer.table.file,
              scenario.magnetometer.source == MagnetometerSource::csv);
    std::error_code error;
    if (std::filesystem::exists(scenario.flash_state.input_file, error)) {
        files.push_back({Setting::flash_input_file, scenario.flash_state.input_file});
    }
    add_output(Setting::flash_output_file, scenario.flash_state.output_file, true);
    add_output(Setting::data_filename, output.data_filename, output.enable_data_logging);
    add_output(Setting::console_filename, output.console_filename, output.enable_console_logging);
    add_output(Setting::message_log, output.message_log, true);
    add_output(std::nullopt, film, true);
    if (output.enable_data_logging && !output.data_filename.empty()) {
        add_beside(Setting::data_filename, complete_file_beside(output.data_filename),
                   " (used to assemble the data file)");
        add_beside(Setting::data_filename, metadata_beside(output.data_filename), " (the metadata of the data file)");
    }
    if (!output.message_log.empty()) {
        add_beside(Setting::message_log, complete_file_beside(output.message_log),
                   " (used to assemble the message log)");
        add_beside(Setting::message_log, metadata_beside(output.message_log), " (the metadata of the message log)");
    }
    if (!film.empty()) {
        add_beside(std::nullopt, FilmFile::path_beside(film), " (used to assemble the film)");
    }
    return files;
}

/// A file, and the temporary one beside it in which it is written; or an archive of flash memory that is replaced.
bool may_be_same(UsedFile const& a, UsedFile const& b) {
    bool const is_archive = a.setting == Setting::flash_output_file && b.setting == Setting::flash_input_file;
    return is_archive || (a.setting == b.setting && a.is_output == b.is_output);
}

/// A device may be used twice: /dev/stdin and /dev/stdout are often one terminal.
bool are_same(std::filesystem::path const& a, std::filesystem::path const& b) {
    std::error_code error;
    bool const both_exist = std::filesystem::exists(a, error) && std::filesystem::exists(b, error);
    if (both_exist) {
        return std::filesystem::is_regular_file(a, error) && std::filesystem::equivalent(a, b, error);
    }
    return real_path(a) == real_path(b);
}

/// "file:line: key", for messages.
std::string where_it_is_named(Scenario const& scenario, UsedFile const& file) {
    return file.setting ? place_of(scenario, *file.setting) : "--video";
}

std::string described(Scenario const& scenario, UsedFile const& file) {
    std::string const name = file.path.string();
    if (file.setting) {
        return fmt::format("{} '{}' ({})", key_of(*file.setting), name, line_of(scenario, *file.setting));
    }
    return file.is_output ? fmt::format("the film '{}' (--video)", name) : fmt::format("{} '{}'", file.purpose, name);
}

char const* fate(UsedFile const& file) {
    return file.is_output ? "which the run also writes" : "which the run would overwrite";
}

void check_frames_name(Scenario const& scenario, std::vector<UsedFile> const& files) {
    if (scenario.view.save_video_period_s <= 0.0) {
        return;
    }
    FrameNames const names(scenario.view.frames_name);
    auto const same = std::ranges::find_if(files, [&](UsedFile const& file) { return names.may_be(file.path); });
    if (same != files.end()) {
        throw ConfigError(fmt::format("{}: a frame may be the same file as {}, {}; choose another name",
                                      place_of(scenario, Setting::frames_name), described(scenario, *same),
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
            if (written.is_output && !may_be_same(written, other) && are_same(written.path, other.path)) {
                throw ConfigError(fmt::format("{}: '{}'{} is the same file as {}, {}; choose another file",
                                              where_it_is_named(scenario, written), written.path.string(),
                                              written.purpose, described(scenario, other), fate(other)));
            }
        }
    }
    check_frames_name(scenario, files);
}

bool is_used_file(Scenario const& scenario, std::string const& film, std::filesystem::path const& path) {
    return std::ranges::any_of(used_files(scenario, film),
                               [&path](UsedFile const& file) { return are_same(file.path, path); });
}

namespace {

namespace fs = std::filesystem;

/// `where`: the key, or the option of the command line.
void check_writable(std::string const& where, std::string const& name) {
    if (std::string const reason = why_not_writable(name); !reason.empty()) {
        throw ConfigError(fmt::format("{}: '{}' cannot be written: {}; choose another file", where, name, reason));
    }
}

void check_table(Scenario const& scenario, Setting setting, std::string const& name) {
    check_table_format(scenario, setting, name);
    check_writable(place_of(scenario, setting), name);
}

void check_film(Scenario const& scenario, std::string const& film) {
    check_ffmpeg(film_format(film));
    check_writable("--video", film);
    Pictures::check_film_speed(scenario);
}

}  // namespace

void check_table_format(Scenario const& scenario, Setting setting, std::string const& name) {
    if (!table_format(name)) {
        throw ConfigError(fmt::format("{}: the format of '{}' is unknown; expected a name that ends in {}",
                                      place_of(scenario, setting), name, kTableEndings));
    }
}

std::string why_not_writable(std::string const& name) {
    std::error_code error;
    fs::path path = fs::absolute(name, error);
    if (fs::is_directory(path, error)) {
        return "it is a folder";
    }
    try {
        check_is_name_of_file(name);
    } catch (FileError const& failure) {
        return failure.what();
    }
    // A file that is not there needs the folder that will contain it, or the folders that will be made for it.
    bool const is_there = fs::exists(path, error);
    while (!fs::exists(path, error) && path.has_relative_path()) {
        path = path.parent_path();
    }
    if (!is_there && !fs::is_directory(path, error)) {
        return std::generic_category().message(ENOTDIR);
    }
    return access(path.c_str(), is_there ? W_OK : W_OK | X_OK) == 0 ? "" : std::generic_category().message(errno);
}

void check_output_files(Scenario const& scenario, std::string const& film, Problems& problems) {
    OutputConfig const& output = scenario.output;
    if (output.enable_data_logging && !output.data_filename.empty()) {
        problems.collect([&] { check_table(scenario, Setting::data_filename, output.data_filename); });
    }
    if (!output.message_log.empty()) {
        problems.collect([&] { check_table(scenario, Setting::message_log, output.message_log); });
    }
    if (output.enable_console_logging && !output.console_filename.empty()) {
        problems.collect(
            [&] { check_writable(place_of(scenario, Setting::console_filename), output.console_filename); });
    }
    if (std::string const& archive = scenario.flash_state.output_file; !archive.empty()) {
        problems.collect([&] {
            check_writable(place_of(scenario, Setting::flash_output_file), archive);
            check_flash_output(scenario);
        });
    }
    problems.collect([&] { Pictures::check_frames(scenario); });
    if (!film.empty()) {
        problems.collect([&] { check_film(scenario, film); });
    }
}

}  // namespace pogosim
