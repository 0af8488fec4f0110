// All mistakes of a configuration are told at once, each with its line.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "base/problems.hpp"
#include "config/scenario.hpp"
#include "config_file.hpp"
#include "lamps/lamp_types.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

std::vector<std::string> lines_of(std::string const& text) {
    std::istringstream all(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(all, line);) {
        lines.push_back(line);
    }
    return lines;
}

/// The beginnings "x.yaml:6: time_step" of all messages.
std::vector<std::string> wrong_keys(std::string const& text, LoadOptions const& options = {}) {
    std::vector<std::string> keys;
    for (std::string const& line : lines_of(load_error(text, options))) {
        keys.push_back(line.substr(0, line.find(": ", line.find(": ") + 1)));
    }
    return keys;
}

using Keys = std::vector<std::string>;

}  // namespace

TEST(SeveralMistakes, EachKeyIsToldWithItsLine) {
    EXPECT_EQ(wrong_keys("objects:\n"
                         "  robots:\n"
                         "    type: pogobot\n"
                         "    nb: many\n"
                         "    radius: 0\n"
                         "    body_restitution: 2\n"
                         "    msg_success_rate: {type: static, rate: 1.5}\n"
                         "    x: 3\n"
                         "  lamp: {type: static_light, geometry: global, value: -1}\n"
                         "  thing: {type: cube}\n"
                         "  list:\n"
                         "    - {type: pogobot, nb: -1}\n"
                         "    - {type: pogobot, nb: two}\n"
                         "time_step: 0\n"
                         "seed: -1\n"
                         "GUI: maybe\n"
                         "initial_formation: heap\n"
                         "boundary_condition: soft\n"
                         "parameters: [1, 2]\n"),
              (Keys{"x.yaml:18: boundary_condition", "x.yaml:14: time_step", "x.yaml:15: seed",
                    "x.yaml:17: initial_formation", "x.yaml:16: GUI", "x.yaml:4: objects.robots.nb",
                    "x.yaml:5: objects.robots.radius", "x.yaml:7: objects.robots.msg_success_rate.rate",
                    "x.yaml:6: objects.robots.body_restitution", "x.yaml:8: objects.robots.x",
                    "x.yaml:9: objects.lamp.value", "x.yaml:10: objects.thing.type", "x.yaml:12: objects.list.0.nb",
                    "x.yaml:13: objects.list.1.nb", "x.yaml:19: parameters"}));
}

TEST(SeveralMistakes, UnknownKeysAreToldToo) {
    EXPECT_EQ(
        lines_of(load_error(kRobots + "    raduis: 3\ntime_setp: 1\nseed: -1\n", {.overrides = {}, .strict = true})),
        (Keys{"x.yaml:8: seed: expected an integer from 0 to 4294967295, found -1",
              "x.yaml:7: unknown key 'time_setp'; did you mean 'time_step'? (--strict)",
              "x.yaml:6: unknown key 'objects.robots.raduis'; did you mean 'radius'? (--strict)"}));
}

TEST(SeveralMistakes, SlipsInWordsOfOptionsAreToldOnceAndWithTheOthers) {
    EXPECT_EQ(lines_of(load_error(kRobots + "    nb: {batch_option: [1, 2], default_option: 1}\n"
                                            "seed: {batch_options: 3, default_option: 1}\ntime_step: 0\n",
                                  {.thorough = true})),
              (Keys{"x.yaml:6: objects.robots.nb: unknown key 'batch_option' beside 'default_option'; did you mean "
                    "'batch_options'?",
                    "x.yaml:7: seed: batch_options: expected a list of values, found 3; write [3]",
                    "x.yaml:8: time_step: expected a number above 0, at most 1 (s), found 0"}));
}

TEST(SeveralMistakes, WrongSettingsOfTheCommandLineAreToldWithTheFilesOwn) {
    auto const lines =
        lines_of(load_error(kRobots + "seed: -1\n", {.overrides = {"time_step=0", "nothing", "a..b=1"}}));
    EXPECT_EQ(lines.size(), 4U) << load_error(kRobots + "seed: -1\n",
                                              {.overrides = {"time_step=0", "nothing", "a..b=1"}});
}

TEST(SeveralMistakes, OneIsAnErrorOfItsOwn) {
    EXPECT_EQ(load_error(kRobots + "seed: -1\n"), "x.yaml:6: seed: expected an integer from 0 to 4294967295, found -1");
}

TEST(SeveralMistakes, ScenarioIsReadBesideItsMistakes) {
    Folder const folder;
    Folder::write("x.yaml", kRobots + "    nb: many\nsimulation_time: 7\n");
    Problems problems;
    Scenario const scenario = read_scenario("x.yaml", {}, object_types(), problems);
    EXPECT_EQ(problems.messages().size(), 1U);
    EXPECT_TRUE(problems.has_key("objects.robots.nb"));
    EXPECT_EQ(scenario.simulation_time_s, 7.0);
    EXPECT_EQ(scenario.objects.front().spec.shape.radius_mm, 26.5F);
}

TEST(ConfigurationsOfOthers, SettingsOfBatchToolsAreNoKeysOfARun) {
    Warnings const warnings;
    Scenario const scenario =
        load(kRobots +
                 "pogobatch: {result_filename_format: 'a_{b}.feather', rundra: {sync: {exclude: [x]}}}\n"
                 "_rundr: {version: 1, seeds: '0:9'}\n",
             {.overrides = {}, .strict = true});
    EXPECT_EQ(warnings.text(), "");
    EXPECT_EQ(scenario.objects.size(), 1U);
}

TEST(ConfigurationsOfOthers, SettingsOfBatchToolsAreMaps) {
    EXPECT_EQ(wrong_keys(kRobots + "pogobatch: 3\n_rundr: [1]\n"), (Keys{"x.yaml:6: pogobatch", "x.yaml:7: _rundr"}));
    EXPECT_EQ(load_error(kRobots + "pogobatch:\n_rundr: null\n"), "no error");
}

TEST(ConfigurationsOfOthers, NamesOfAlternativesInTheSettingsOfBatchToolsAreKnown) {
    Warnings const warnings;
    load(kRobots + "kind: fast\npogobatch: {result_new_columns: [kind]}\n", {.overrides = {}, .strict = true});
    EXPECT_EQ(warnings.text(), "");
}

TEST(ConfigurationsOfOthers, CoroutineStackIsTheStackInBytes) {
    EXPECT_EQ(load(kRobots + "coroutine_stack_size: 262144\n").robot_stack_kib, 256);
    EXPECT_EQ(load(kRobots + "coroutine_stack_size: 1e6\n").robot_stack_kib, 977);
    EXPECT_EQ(load(kRobots + "coroutine_stack_size: 1\n").robot_stack_kib, 64);
    EXPECT_EQ(load(kRobots + "coroutine_stack_size: null\n").robot_stack_kib, 8192);
    EXPECT_EQ(load(kRobots).robot_stack_kib, 8192);
    EXPECT_EQ(load_error(kRobots + "coroutine_stack_size: 0\n"),
              "x.yaml:6: coroutine_stack_size: expected an integer from 1 to 1073741824 (bytes), found 0");
    EXPECT_EQ(load_error(kRobots + "coroutine_stack_size: 131072\nrobot_stack_size: 128\n"),
              "x.yaml:6: coroutine_stack_size: is an alias of robot_stack_size; use one or the other");
}

TEST(ConfigurationsOfOthers, BooleansMayBeNumbers) {
    EXPECT_TRUE(load(kRobots + "arena_stretch: 1\n").arena_stretch);
    EXPECT_FALSE(load(kRobots + "GUI: 0\n").view.gui);
    EXPECT_NE(load_error(kRobots + "GUI: 2\n").find("expected true or false, found 2"), std::string::npos);
}

TEST(ConfigurationsOfOthers, WholeNumbersMayBeWrittenWithAnExponent) {
    EXPECT_EQ(load(kRobots + "    nb: 1e3\n").objects.front().nb, 1000);
}

TEST(ConfigurationsOfOthers, NullIsTheDefault) {
    Warnings const warnings;
    Scenario const scenario =
        load(kRobots + "    nb: null\ntime_step: null\nparameters: null\nGUI_speed_up: null\nseed: ~\n");
    EXPECT_EQ(scenario.time_step_s, 0.01);
    EXPECT_EQ(scenario.objects.front().nb, 1);
    EXPECT_EQ(warnings.text(), "");
}

TEST(ConfigurationsOfOthers, OldKeysThatMakeNoRobotAreRefusedWithWhatToWrite) {
    EXPECT_EQ(
        load_error("nBots: 12\ncommRadius: 90\n"),
        "x.yaml:1: nBots: no robot would be created: the keys of versions before 0.10 (nBots, commRadius) have no "
        "effect. Describe the robots under 'objects', as in objects: {robots: {type: pogobot, nb: 12, geometry: "
        "disk, radius: 26.5}}, or begin with a new project: pogosim new NAME");
    EXPECT_EQ(load_error(kRobots + "nBots: 12\n"), "no error");
}

TEST(ConfigurationsOfOthers, NoRobotWithoutOldKeysIsAWarning) {
    Warnings const warnings;
    EXPECT_EQ(load_error("objects: null\n"), "no error");
    EXPECT_NE(warnings.text().find("there are no robots in this configuration"), std::string::npos);
}

TEST(OpenOptions, SingleRunSaysThatTheyAreForABatch) {
    Warnings const warnings;
    EXPECT_EQ(load(kRobots + "    nb: {batch_options: [3, 4]}\n").objects.front().nb, 1);
    EXPECT_EQ(warnings.lines(), (std::vector<std::string>{"x.yaml:6: objects.robots.nb: has batch_options but no "
                                                          "default_option; run it with pogobatch (a single run takes "
                                                          "the default, 1)"}));
}

TEST(OpenOptions, RequiredValueIsNotSaidToBeMissing) {
    EXPECT_EQ(load_error("objects:\n  thing: {type: passive_object, geometry: {batch_options: [disk, rectangle]}}\n"),
              "x.yaml:2: objects.thing.geometry: has batch_options but no default_option; run it with pogobatch");
    EXPECT_EQ(load_error("objects:\n  thing: {type: {batch_options: [pogobot, membrane]}}\n"),
              "x.yaml:2: objects.thing.type: has batch_options but no default_option; run it with pogobatch");
    EXPECT_EQ(load_error(kRobots + "arena_file: {batch_options: [a.csv, b.csv]}\n"),
              "x.yaml:6: arena_file: has batch_options but no default_option; run it with pogobatch");
    EXPECT_EQ(load_error(kRobots + "    poses: [{batch_options: [[0, 0], [1, 1]]}]\n"),
              "x.yaml:6: objects.robots.poses.0: has batch_options but no default_option; run it with pogobatch");
}

TEST(OpenOptions, OtherWordsAreNamed) {
    Warnings const warnings;
    load(kRobots +
         "    nb: {batch_options_range: {start: 1, stop: 3, step: 1}}\n"
         "    radius: {optimization_domain: {type: float, min: 1, max: 2}}\n");
    EXPECT_NE(warnings.text().find("has batch_options_range but no default_option; run it with pogobatch"),
              std::string::npos);
    EXPECT_NE(warnings.text().find("has optimization_domain but neither default_option nor init; run it with pogoptim"),
              std::string::npos);
}

TEST(StrictValues, WhatWouldBeCutOrReplacedIsRefused) {
    LoadOptions const strict{.strict_values = true};
    EXPECT_EQ(load_error(kRobots + "    nb: 2.5\n", strict),
              "x.yaml:6: objects.robots.nb: expected an integer, found 2.5");
    EXPECT_EQ(load_error(kRobots + "    nb: {batch_options: [3, 4]}\n", strict),
              "x.yaml:6: objects.robots.nb: has batch_options but no default_option; run it with pogobatch");
    EXPECT_NE(load_error(kLamp + "    light_mode: bright\n", strict).find("expected one of static, gradient, plane"),
              std::string::npos);
    EXPECT_EQ(load_error(kRobots + "some_key: 3\n", strict), "no error");
    EXPECT_EQ(load_error(kRobots + "    nb: 1e3\nGUI: 1\nboundary_condition: null\n", strict), "no error");
}

TEST(UnusedValues, AreCheckedIfAsked) {
    std::vector<std::string> const unused{"chessboard_distance_between_neighbors: 0", "GUI: false\nGUI_speed_up: -1",
                                          "formation_attempts_per_point: 0",
                                          "formation_min_space_between_neighbors: 9\n"
                                          "formation_max_space_between_neighbors: 3"};
    for (std::string const& text : unused) {
        EXPECT_EQ(load_error(kRobots + text + "\n"), "no error") << text;
        EXPECT_NE(load_error(kRobots + text + "\n", {.thorough = true}), "no error") << text;
    }
}

TEST(UnusedValues, LargestSpaceIsNotBelowTheSmallest) {
    EXPECT_EQ(
        load_error(kRobots + "initial_formation: random\nformation_min_space_between_neighbors: 50\n"
                             "formation_max_space_between_neighbors: 20\n"),
        "x.yaml:8: formation_max_space_between_neighbors: expected at least formation_min_space_between_neighbors, "
        "50 mm, found 20");
}
