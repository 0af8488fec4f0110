#include "sim/flash_state.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string_view>
#include <system_error>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/new_file.hpp"
#include "config/places.hpp"

namespace pogosim {

namespace {

namespace fs = std::filesystem;

/// Throws ConfigError if the archive cannot name all robots.
RobotsByOwner robots_by_owner(Scenario const& scenario, World const& world) {
    RobotsByOwner robots;
    for (std::uint32_t robot = 0; robot < world.robots.size(); ++robot) {
        std::uint32_t const id = world.robots.id[robot];
        std::string const& category = world.categories[world.robots.category[robot]].name;
        if (id >= kIdsOnAir || category.size() > std::numeric_limits<std::uint16_t>::max()) {
            throw ConfigError(
                fmt::format("{}: expected at most {} objects and categories with short names: the ids of robots have "
                            "16 bits in an archive of flash memory",
                            line_of(scenario, scenario.flash_state.input_file.empty() ? Setting::flash_output_file
                                                                                      : Setting::flash_input_file),
                            kIdsOnAir));
        }
        robots.emplace(FlashOwner{.category = category, .id = id_on_air(id)}, robot);
    }
    return robots;
}

FlashRecord record_of(FlashOwner const& owner, Devices const& devices, std::size_t robot) {
    return {.owner = owner,
            .directions = devices.motors[robot].stored_direction,
            .powers = devices.motors[robot].stored_power,
            .flash = devices.flash[robot]};
}

[[noreturn]] void refuse_input(Scenario const& scenario, std::string const& reason) {
    throw ConfigError(fmt::format("{}: '{}': {}", place_of(scenario, Setting::flash_input_file),
                                  scenario.flash_state.input_file, reason));
}

/// Whether there is an input. Throws ConfigError if there is none, and must be one.
bool has_input(Scenario const& scenario) {
    std::error_code error;
    if (fs::exists(scenario.flash_state.input_file, error)) {
        return true;
    }
    if (!scenario.flash_state.create_if_missing) {
        refuse_input(scenario, fmt::format("there is no such file in '{}' (create_if_missing: false); write one with "
                                           "output_file, or with: pogosim flash make",
                                           fs::current_path(error).string()));
    }
    return false;
}

/// Where there is no input, and there may be none, writes one without records.
void provide_input(Scenario const& scenario) {
    if (has_input(scenario)) {
        return;
    }
    std::string const& name = scenario.flash_state.input_file;
    try {
        check_is_name_of_file(name);
        fs::path const path = real_path(name);
        make_parent_folder(path);
        NewFile file(path);
        write_all(file.descriptor(), flash_archive_head(0));
        file.take_free_place();
    } catch (FileError const& failure) {
        throw OutputError(fmt::format("{}: cannot write '{}' (create_if_missing): {}",
                                      place_of(scenario, Setting::flash_input_file), name, failure.what()));
    }
    log().info("{}: there was no '{}': it is now an archive without records, and flash memory is blank",
               place_of(scenario, Setting::flash_input_file), name);
}

std::ifstream open_input(Scenario const& scenario) {
    std::error_code error;
    if (!fs::is_regular_file(scenario.flash_state.input_file, error)) {
        refuse_input(scenario, "it is not a file");
    }
    std::ifstream file(scenario.flash_state.input_file, std::ios::binary);
    if (!file) {
        refuse_input(scenario, "it cannot be read: " + std::generic_category().message(errno));
    }
    return file;
}

/// As read_flash_archive(), with ConfigError for what is wrong.
std::uint32_t read_input(Scenario const& scenario, std::istream& file, std::function<void(FlashRecord&&)> const& take) {
    try {
        return read_flash_archive(file, take);
    } catch (FileError const& error) {
        refuse_input(scenario, error.what());
    }
}

/// Returns the number of records. Throws ConfigError if some robots have none, unless there are none at all.
std::uint32_t restore(Scenario const& scenario, std::istream& file, RobotsByOwner robots, Devices& devices) {
    std::size_t const count = robots.size();
    std::uint32_t const records = read_input(scenario, file, [&](FlashRecord&& record) {
        if (auto const robot = robots.extract(record.owner)) {
            devices.flash[robot.mapped()] = std::move(record.flash);
            devices.motors[robot.mapped()].stored_direction = record.directions;
            devices.motors[robot.mapped()].stored_power = record.powers;
        }
    });
    if (records > 0 && !robots.empty()) {
        refuse_input(scenario,
                     fmt::format("it has no record of {}{} ({} in all, for {}); take an archive of these robots, or "
                                 "make one with: pogosim flash make",
                                 described(robots.begin()->first),
                                 robots.size() > 1 ? fmt::format(", and of {} more", robots.size() - 1) : "",
                                 counted(records, "record"), counted(count, "robot")));
    }
    return records;
}

}  // namespace

FlashState::FlashState(Scenario const& scenario, World& world) : files_(scenario.flash_state) {
    if (files_.input_file.empty() && files_.output_file.empty()) {
        return;
    }
    robots_ = robots_by_owner(scenario, world);
    check_flash_output(scenario);
    if (!files_.input_file.empty()) {
        provide_input(scenario);
    }
    // Reserved first: if it is the input, too, no other run changes it from here on.
    if (!files_.output_file.empty()) {
        try {
            reserve_output();
        } catch (FileError const& error) {
            throw OutputError(fmt::format("{}: cannot write '{}': {}", place_of(scenario, Setting::flash_output_file),
                                          files_.output_file, error.what()));
        }
    }
    if (!files_.input_file.empty()) {
        input_ = open_input(scenario);
        input_records_ = restore(scenario, input_, robots_, world.devices);
        if (input_records_ == 0) {
            warn_of_blank_start(scenario);
        }
    }
}

void FlashState::reserve_output() {
    fs::path const path = real_path(files_.output_file);
    std::error_code error;
    if (fs::exists(path, error) && !fs::is_regular_file(path, error)) {
        throw FileError("it is not a file");
    }
    check_is_name_of_file(files_.output_file);
    make_parent_folder(path);
    output_ = LockedFile(path);
    if (fs::file_size(path, error) == 0) {
        write_all(output_.descriptor(), flash_archive_head(0));
    }
    NewFile const trial(path);  // a folder in which nothing can be written is known before the run
}

void FlashState::save(World const& world) {
    if (files_.output_file.empty()) {
        return;
    }
    try {
        NewFile file(output_.path());
        auto const write = [&](FlashRecord const& record) {
            write_all(file.descriptor(), flash_archive_record(record));
        };
        auto const state_of = [&](FlashOwner const& owner, std::uint32_t robot) {
            return record_of(owner, world.devices, robot);
        };
        write_all(file.descriptor(),
                  flash_archive_head(static_cast<std::uint32_t>(input_records_ > 0 ? input_records_ : robots_.size())));
        if (input_records_ > 0) {
            input_.clear();
            input_.seekg(0);
            read_flash_archive(input_, [&](FlashRecord&& record) {
                auto const robot = robots_.find(record.owner);
                write(robot == robots_.end() ? record : state_of(record.owner, robot->second));
            });
        } else {
            for (auto const& [owner, robot] : robots_) {
                write(state_of(owner, robot));
            }
        }
        file.replace(output_);
    } catch (FileError const& error) {
        throw OutputError(
            fmt::format("cannot write the archive of flash memory '{}' (flash_state.output_file): {}. It "
                        "is as before",
                        files_.output_file, error.what()));
    }
}

void check_flash_output(Scenario const& scenario) {
    FlashStateConfig const& files = scenario.flash_state;
    std::error_code error;
    if (!fs::is_regular_file(files.output_file, error) || fs::file_size(files.output_file, error) == 0 ||
        fs::equivalent(files.output_file, files.input_file, error)) {
        return;  // what is wrong with an input is said where it is read
    }
    std::ifstream file(files.output_file, std::ios::binary);
    if (file && !begins_as_flash_archive(file)) {
        throw ConfigError(
            fmt::format("{}: '{}' is not an archive of flash memory, and would be lost: it does not "
                        "begin with PGFLASH; choose another file, or remove it",
                        place_of(scenario, Setting::flash_output_file), files.output_file));
    }
}

bool starts_blank(Scenario const& scenario) {
    FlashStateConfig const& files = scenario.flash_state;
    std::error_code error;
    if (files.input_file.empty()) {
        return false;
    }
    if (!fs::exists(files.input_file, error)) {
        return files.create_if_missing;
    }
    if (!fs::is_regular_file(files.input_file, error)) {
        return false;  // opening a pipe would wait
    }
    std::string const empty = flash_archive_head(0);
    std::ifstream file(files.input_file, std::ios::binary);
    std::string start(empty.size(), '\0');
    bool const begins_so = file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == empty;
    return begins_so && file.peek() == std::ifstream::traits_type::eof();  // else it is damaged
}

void warn_of_blank_start(Scenario const& scenario) {
    FlashStateConfig const& files = scenario.flash_state;
    if (!files.output_file.empty() && real_path(files.input_file) == real_path(files.output_file)) {
        return;
    }
    log().warn(
        "{}: '{}' has no records, so the flash memory of all robots is blank at the start; if it should not be, "
        "check the name (where there is no file, create_if_missing makes one without records)",
        place_of(scenario, Setting::flash_input_file), files.input_file);
}

void check_flash_input(Scenario const& scenario) {
    if (!scenario.flash_state.input_file.empty() && has_input(scenario)) {
        std::ifstream file = open_input(scenario);
        read_input(scenario, file, [](FlashRecord&&) {});
    }
}

std::string FlashState::note() const {
    return files_.output_file.empty()
               ? ""
               : fmt::format(". Flash memory is not saved; '{}' (flash_state.output_file) is as before",
                             files_.output_file);
}

}  // namespace pogosim
