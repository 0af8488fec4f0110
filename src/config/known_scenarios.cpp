#include "config/known_scenarios.hpp"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "base/log.hpp"
#include "base/recent.hpp"
#include "config/looked_up.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kMostKnown = 16;
constexpr std::size_t kMostBytes = 1U << 20U;  // of its files: larger ones are not kept in memory
constexpr std::size_t kMostObjects = 10'000;

/// All that the result depends on, besides the files.
struct Question {
    std::string path;
    LoadOptions options;
    std::filesystem::path folder;  // in which it was asked
    std::string search_path;       // POGOSIM_PATH

    bool operator==(Question const&) const = default;
};

struct Known {
    Question question;
    LookedUp files;
    Scenario scenario;
    std::vector<LogLine> lines;  // that were logged
};

Recent<Known> all_known(kMostKnown);

void say(std::vector<LogLine> const& lines) {
    for (LogLine const& line : lines) {
        log().log(static_cast<spdlog::level::level_enum>(line.level), "{}", line.text);
    }
}

/// Answers the question. Returns what load_scenario() throws.
std::exception_ptr load(Known& found, ObjectTypes const& types) {
    LogOptions to_lines;
    to_lines.verbose = true;
    to_lines.on_line = [&](LogLine const& line) { found.lines.push_back(line); };
    Log noted(to_lines);
    LogScope const scope(&noted);
    LookedUpScope const looking(found.files);
    try {
        found.scenario = load_scenario(found.question.path, found.question.options, types);
        return nullptr;
    } catch (...) {
        return std::current_exception();
    }
}

}  // namespace

Scenario load_known_scenario(std::string const& path, LoadOptions const& options, ObjectTypes const& types) {
    std::error_code error;
    char const* const search_path = std::getenv("POGOSIM_PATH");
    Question const question{.path = path,
                            .options = options,
                            .folder = std::filesystem::current_path(error),
                            .search_path = search_path != nullptr ? search_path : ""};
    auto const asks_it = [&](Known const& known) { return known.question == question; };
    if (auto const known = all_known.find(asks_it); known && known->files.is_still_there()) {
        say(known->lines);
        return known->scenario;
    }
    auto const found = std::make_shared<Known>();
    found->question = question;
    std::exception_ptr const failure = load(*found, types);
    say(found->lines);
    if (failure) {
        std::rethrow_exception(failure);
    }
    if (!error && found->files.size() <= kMostBytes && found->scenario.objects.size() <= kMostObjects) {
        all_known.keep(found, asks_it);
    }
    return found->scenario;
}

}  // namespace pogosim
