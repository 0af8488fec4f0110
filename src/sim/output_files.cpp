#include "sim/output_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "base/locked_file.hpp"
#include "base/table_format.hpp"
#include "render/film_format.hpp"
#include "sim/flash_state.hpp"
#include "sim/pictures.hpp"

namespace pogosim {

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
