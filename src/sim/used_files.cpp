#include "sim/used_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "base/locked_file.hpp"
#include "record/data_file.hpp"
#include "sim/find_file.hpp"

namespace pogosim {

namespace {

struct UsedFile {
    std::string key;             // empty: the configuration
    std::filesystem::path path;  // as the run opens it
    bool is_output = false;
    bool is_beside = false;  // the data file is put together there
};

/// Files that this run does not use are omitted.
std::vector<UsedFile> used_files(Scenario const& scenario, std::string const& configuration) {
    std::vector<UsedFile> files{{"", configuration}};
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
    if (output.enable_data_logging && !output.data_filename.empty()) {
        files.push_back(
            {"data_filename", DataFile::path_beside(output.data_filename), /*is_output=*/true, /*is_beside=*/true});
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

std::string described(Scenario const& scenario, UsedFile const& file) {
    return file.key.empty()
               ? fmt::format("the configuration file '{}'", file.path.string())
               : fmt::format("{} '{}' ({})", file.key, file.path.string(), where_at_top(scenario, file.key));
}

}  // namespace

void check_used_files(Scenario const& scenario, std::string const& configuration) {
    std::vector<UsedFile> const files = used_files(scenario, configuration);
    for (std::size_t i = 0; i < files.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            UsedFile const& written = files[i];
            UsedFile const& other = files[j];
            if (written.is_output && written.key != other.key && are_same(written.path, other.path)) {
                throw ConfigError(fmt::format(
                    "{}: {}: '{}'{} is the same file as {}, {}; choose another file",
                    where_at_top(scenario, written.key), written.key, written.path.string(),
                    written.is_beside ? " (used to assemble the data file)" : "", described(scenario, other),
                    other.is_output ? "which the run also writes" : "which the run would overwrite"));
            }
        }
    }
}

}  // namespace pogosim
