#include "sim/state_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <istream>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/fnv_1a.hpp"
#include "base/new_file.hpp"
#include "config/configuration_text.hpp"
#include "firmware/firmware_brain.hpp"
#include "physics/physics_engine.hpp"
#include "pogosim/version.h"
#include "process/loaded_modules.hpp"
#include "sim/object_facts.hpp"

namespace pogosim {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSignature{"PGSTATE\0", 8};
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kHeadBytes = 8 + sizeof(std::uint32_t) + sizeof(std::uint64_t);

/// Keys that decide for how long a run goes on, and what it writes and shows: a state goes on with others.
constexpr std::array<std::string_view, 28> kFreeKeys{"simulation_time",
                                                     "seed",
                                                     "user_code_timeout",
                                                     "enable_data_logging",
                                                     "data_filename",
                                                     "save_data_period",
                                                     "save_data_times",
                                                     "data_logger_fields",
                                                     "data_logger_category",
                                                     "data_logger_flush_row_count",
                                                     "data_logger_led",
                                                     "message_log",
                                                     "enable_console_logging",
                                                     "console_filename",
                                                     "log_format",
                                                     "GUI",
                                                     "GUI_speed_up",
                                                     "window_width",
                                                     "window_height",
                                                     "mm_to_pixels",
                                                     "save_video_period",
                                                     "frames_name",
                                                     "delete_old_files",
                                                     "progress_bar",
                                                     "batch_options",
                                                     "optimization",
                                                     "flash_state",
                                                     "view"};

bool is_free(std::string_view key) {
    return key.starts_with("show_") || std::ranges::find(kFreeKeys, key) != kFreeKeys.end();
}

/// The lines of the keys at the top of a YAML text, without those of free keys.
std::string without_free_keys(std::string_view text) {
    std::string kept;
    bool is_kept = true;
    while (!text.empty()) {
        std::size_t const end = std::min(text.find('\n'), text.size() - 1) + 1;
        std::string_view const line = text.substr(0, end);
        text.remove_prefix(end);
        if (line.find_first_of(" -#\n") != 0) {
            is_kept = !is_free(line.substr(0, line.find(':')));
        }
        if (is_kept) {
            kept += line;
        }
    }
    return kept;
}

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        std::size_t const end = std::min(text.find('\n'), text.size());
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

std::size_t indent_of(std::string const& line) {
    return std::min(line.find_first_not_of(' '), line.size());
}

/// "objects: robots: nb: 30", from the keys above a line.
std::string path_of(std::vector<std::string> const& lines, std::size_t at) {
    std::string path = lines[at].substr(indent_of(lines[at]));
    std::size_t indent = indent_of(lines[at]);
    for (std::size_t i = at; i-- > 0 && indent > 0;) {
        if (indent_of(lines[i]) < indent) {
            indent = indent_of(lines[i]);
            path = lines[i].substr(indent) + ' ' + path;
        }
    }
    return path;
}

std::vector<std::string> entries_of(std::string const& text) {
    std::vector<std::string> const lines = lines_of(text);
    std::vector<std::string> entries;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!lines[i].ends_with(':')) {  // what is below says it
            entries.push_back(path_of(lines, i));
        }
    }
    return entries;
}

[[noreturn]] void refuse(StateFile const& saved, std::string const& reason) {
    throw ConfigError(fmt::format("--from-state: '{}' {}", saved.file.string(), reason));
}

/// The first entry that is not among others; empty if all are.
std::string first_beyond(std::vector<std::string> const& entries, std::vector<std::string> const& others) {
    auto const beyond = std::ranges::find_if(
        entries, [&](std::string const& entry) { return std::ranges::find(others, entry) == others.end(); });
    return beyond == entries.end() ? "" : *beyond;
}

std::string difference(std::string const& saved, std::string const& own) {
    std::vector<std::string> const before = entries_of(saved);
    std::vector<std::string> const now = entries_of(own);
    std::string const then = first_beyond(before, now);
    std::string const new_one = first_beyond(now, before);
    if (then.empty() && new_one.empty()) {
        return "its entries are in another order";
    }
    if (then.empty() || new_one.empty()) {
        return then.empty() ? fmt::format("'{}' is new", new_one) : fmt::format("'{}' is no longer there", then);
    }
    return fmt::format("'{}' then, and '{}' now", then, new_one);
}

std::string_view text_of(std::span<std::byte const> bytes) {
    return {reinterpret_cast<char const*>(bytes.data()), bytes.size()};
}

/// The first bytes of a file; fewer: it has no more, or cannot be read.
std::vector<std::byte> bytes_of(std::istream& file, std::size_t count) {
    std::vector<std::byte> bytes(count);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
}

/// `bytes`: of the whole file, whose memory the state takes over. Throws ForeignState.
StateFile state_in(std::vector<std::byte> bytes) {
    if (!text_of(bytes).starts_with(kSignature)) {
        throw ForeignState("is not the state of a run");
    }
    if (bytes.size() < kHeadBytes) {
        throw ForeignState("is cut off");
    }
    StateReader reader(std::span<std::byte const>(bytes).subspan(kSignature.size()));
    std::uint32_t version = 0;
    std::uint64_t count = 0;
    reader(version, count);
    if (version != kVersion) {
        throw ForeignState(fmt::format("was written by another version of Pogosim: its format is {}, and this is {}",
                                       version, kVersion));
    }
    std::size_t const rest = reader.rest().size();
    if (rest < sizeof(std::uint64_t) || count > rest - sizeof(std::uint64_t)) {
        throw ForeignState(fmt::format("is cut off: it has {} bytes", bytes.size()));
    }
    if (std::uint64_t const more = rest - sizeof(std::uint64_t) - count; more > 0) {
        throw ForeignState(fmt::format("is longer than the state that it begins with, by {}", counted(more, "byte")));
    }
    StateReader content(reader.take_bytes(count));
    std::uint64_t checksum = 0;
    reader(checksum);
    if (fnv_1a(text_of(bytes).substr(0, kHeadBytes + count)) != checksum) {
        throw ForeignState("is damaged: its checksum is not that of its bytes");
    }
    StateFile saved;
    std::size_t size = 0;
    content(saved, size);
    if (size != content.rest().size()) {
        throw ForeignState("is damaged: its state has another size than it says");
    }
    std::size_t const end = bytes.size() - sizeof(checksum);
    bytes.resize(end);
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(end - size));
    saved.state = std::move(bytes);
    return saved;
}

}  // namespace

RunIdentity identity_of(ProgramImage const& image, Scenario const& scenario, World const& world, Brains const& brains,
                        std::uint64_t inputs) {
    RunIdentity identity;
    identity.version = POGOSIM_VERSION_STRING;
    std::vector<LoadedModule> const modules = loaded_modules();
    if (LoadedModule const* const own = module_at(modules, reinterpret_cast<void const*>(&identity_of))) {
        identity.build = own->build;
    }
    identity.program = fs::path(image.name).filename().string();
    if (LoadedModule const* const own = module_at(modules, reinterpret_cast<void const*>(image.main))) {
        identity.program_build = own->build;
    }
    RunValues const run{.time_step_s = scenario.time_step_s,
                        .is_periodic = world.periodic,
                        .physics_engine = physics_engine_behind(scenario.physics_engine)};
    identity.configuration = without_free_keys(configuration_text(scenario, run).resolved);
    identity.files = fnv_1a(object_facts(scenario, world), inputs);
    for (Polygon const& polygon : world.arena.polygons) {
        identity.files = fnv_1a({reinterpret_cast<char const*>(polygon.data()), polygon.size() * sizeof(polygon[0])},
                                identity.files);
    }
    for (auto const& brain : brains) {
        if (auto const* const firmware = dynamic_cast<FirmwareBrain const*>(brain.get())) {
            std::vector<std::byte> const& bytes = firmware->program()->bytes;
            identity.files = fnv_1a({reinterpret_cast<char const*>(bytes.data()), bytes.size()}, identity.files);
        }
    }
    return identity;
}

StateFile read_state(fs::path const& file) {
    StateFile unread{.file = file};
    std::error_code error;
    if (!fs::exists(file, error)) {
        refuse(unread, fmt::format("does not exist in '{}'", fs::current_path(error).string()));
    }
    if (!fs::is_regular_file(file, error)) {
        refuse(unread, "is not a file");
    }
    std::ifstream input(file, std::ios::binary);
    if (!input) {
        refuse(unread, fmt::format("cannot be read: {}", std::generic_category().message(errno)));
    }
    std::uintmax_t const size = fs::file_size(file, error);
    std::vector<std::byte> bytes = bytes_of(input, error ? 0 : static_cast<std::size_t>(size));
    if (bytes.empty()) {
        refuse(unread, "is empty: the run that was to write it has not");
    }
    try {
        StateFile saved = state_in(std::move(bytes));
        saved.file = file;
        return saved;
    } catch (ForeignState const& foreign) {
        refuse(unread, foreign.what());
    }
}

void check_identity(StateFile const& saved, RunIdentity const& identity) {
    RunIdentity const& before = saved.identity;
    if (before.version != identity.version) {
        refuse(saved, fmt::format("is of Pogosim {}, and this is {}: go on with that version", before.version,
                                  identity.version));
    }
    if (before.build != identity.build) {
        refuse(saved, "is of another build of this version of Pogosim: go on with that one");
    }
    if (before.program_build != identity.program_build) {
        refuse(saved, before.program != identity.program
                          ? fmt::format("is of the program '{}', and this is '{}'", before.program, identity.program)
                          : fmt::format("is of another build of '{}': go on with that executable", before.program));
    }
    if (before.configuration != identity.configuration) {
        refuse(saved, fmt::format("is of another configuration: {}. Only simulation_time, user_code_timeout, "
                                  "threads and what is written and shown may differ",
                                  difference(before.configuration, identity.configuration)));
    }
    if (before.files != identity.files) {
        refuse(saved,
               "is of a run whose arena, robot models, firmware or scripts were others: a file that the "
               "configuration names has changed");
    }
}

StateOutput::StateOutput(fs::path const& file) : name_(file) {
    try {
        std::error_code error;
        std::ifstream earlier(fs::is_regular_file(file, error) ? file : fs::path(), std::ios::binary);
        std::vector<std::byte> const begin = bytes_of(earlier, kSignature.size());
        if (!begin.empty() && text_of(begin) != kSignature) {
            throw ConfigError(
                fmt::format("--save-state: '{}' is not the state of a run, and would be lost; choose another file, or "
                            "remove it",
                            file.string()));
        }
        if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
            throw FileError("it is not a file");
        }
        check_is_name_of_file(file);
        fs::path const path = real_path(file);
        make_parent_folder(path);
        reserved_ = LockedFile(path);
        NewFile::remove_unfinished(path);  // of runs that were killed: none but this one writes here
        NewFile const trial(path);         // a folder in which nothing can be written is known before the run
    } catch (FileError const& failure) {
        throw OutputError(fmt::format("--save-state: cannot write '{}': {}", file.string(), failure.what()));
    }
}

void StateOutput::write(StateFile const& kind, std::span<std::byte const> state) {
    StateWriter before;
    before(kind, state.size());
    StateWriter head;
    head.add_bytes(std::as_bytes(std::span(kSignature)));
    head(kVersion, std::uint64_t{before.bytes().size() + state.size()});
    head.add_bytes(before.bytes());
    StateWriter checksum;
    checksum(fnv_1a(text_of(state), fnv_1a(text_of(head.bytes()))));
    try {
        NewFile file(reserved_.path());
        for (std::span<std::byte const> const part : {std::span(head.bytes()), state, std::span(checksum.bytes())}) {
            write_all(file.descriptor(), text_of(part));
        }
        LockedFile written(reserved_.path(), file.descriptor());  // before another run can see it
        file.replace(reserved_);
        reserved_.keep();
        reserved_ = std::move(written);
    } catch (FileError const& failure) {
        throw OutputError(
            fmt::format("--save-state: cannot write '{}': {}. It is as before", name_.string(), failure.what()));
    }
}

}  // namespace pogosim
