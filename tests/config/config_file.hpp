// Configuration files for tests: written, loaded, their warnings and errors looked at.
#pragma once

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "config/scenario.hpp"
#include "lamps/lamp_types.hpp"

namespace pogosim::config_file {

/// A folder that goes away with the test; the working directory while it lives, so that messages name plain files.
class Folder {
public:
    Folder() : before_(std::filesystem::current_path()) {
        std::string const test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        path_ = std::filesystem::temp_directory_path() / ("pogosim_config_" + std::to_string(getpid()) + "_" + test);
        std::filesystem::create_directories(path_);
        std::filesystem::current_path(path_);
    }
    Folder(Folder const&) = delete;
    Folder& operator=(Folder const&) = delete;
    ~Folder() {
        std::filesystem::current_path(before_);
        std::filesystem::remove_all(path_);
    }

    static void write(std::string const& name, std::string const& text) {
        std::ofstream(name, std::ios::binary) << text;
    }

private:
    std::filesystem::path before_;
    std::filesystem::path path_;
};

/// Collects the warnings of the simulator instead of showing them.
class Warnings {
public:
    Warnings() : before_(std::exchange(log().sinks(), {})) {
        auto sink = std::make_shared<spdlog::sinks::ostream_sink_st>(text_);
        sink->set_pattern("%v");
        sink->set_level(spdlog::level::warn);
        log().sinks().push_back(sink);
    }
    Warnings(Warnings const&) = delete;
    Warnings& operator=(Warnings const&) = delete;
    ~Warnings() { log().sinks() = before_; }

    std::string text() const { return text_.str(); }
    std::vector<std::string> lines() const {
        std::istringstream all(text_.str());
        std::vector<std::string> lines;
        for (std::string line; std::getline(all, line);) {
            lines.push_back(line);
        }
        return lines;
    }

private:
    std::ostringstream text_;
    std::vector<spdlog::sink_ptr> before_;
};

inline Scenario load(std::string const& text, LoadOptions const& options = {}) {
    Folder const folder;
    Folder::write("x.yaml", text);
    return load_scenario("x.yaml", options, object_types());
}

/// The message of the ConfigError that `action` throws.
template <class Action>
std::string error_of(Action const& action) {
    try {
        action();
    } catch (ConfigError const& error) {
        return error.what();
    }
    return "no error";
}

inline std::string load_error(std::string const& text, LoadOptions const& options = {}) {
    return error_of([&] { load(text, options); });
}

/// A smallest complete configuration: lines 1 to 5, to which a test adds its own.
inline std::string const kRobots = "objects:\n  robots:\n    type: pogobot\n    geometry: disk\n    radius: 26.5\n";
inline std::string const kLamp =
    "objects:\n  robots: {type: pogobot, geometry: disk}\n  lamp:\n"
    "    type: static_light\n    geometry: global\n";

}  // namespace pogosim::config_file
