// The resolved values of a configuration, defaults included: resolved_configuration in the data file.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "config/source.hpp"
#include "config_file.hpp"
#include "lamps/lamp_types.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

std::vector<std::string> keys_of(Node const& map) {
    std::vector<std::string> keys;
    for (auto const& [key, value] : map.entries) {
        keys.push_back(key);
    }
    return keys;
}

bool has(Node const& map, std::string const& key) {
    return map.find(key) != nullptr;
}

Node robots_of(std::string const& keys) {
    return *find_path(load(kRobots + keys).source->values, "objects.robots");
}

/// A configuration that holds all its values gives the same values, without a warning but that of walls that add
/// energy.
void expect_complete(Scenario const& scenario) {
    Warnings const warnings;
    Folder const folder;
    std::string const text = to_yaml(scenario.source->values);
    Folder::write("values.yaml", text);
    Scenario const again = load_scenario("values.yaml", {.overrides = {}, .strict = true}, object_types());
    EXPECT_EQ(to_yaml(again.source->values), text);
    ASSERT_EQ(again.objects.size(), scenario.objects.size());
    for (std::size_t i = 0; i < scenario.objects.size(); ++i) {
        EXPECT_TRUE(again.objects[i].spec == scenario.objects[i].spec) << scenario.objects[i].category;
    }
    std::vector<std::string> lines = warnings.lines();
    std::erase_if(lines, [](std::string const& line) { return line.find("walls add energy") != std::string::npos; });
    EXPECT_EQ(lines, std::vector<std::string>());
}

}  // namespace

TEST(ValuesInUse, HoldEveryDefault) {
    Scenario const scenario = load(kRobots);
    EXPECT_EQ(scenario.source->values.find("simulation_time")->scalar, "100");
    EXPECT_EQ(scenario.source->values.find("initial_formation")->scalar, "power_lloyd");
    EXPECT_EQ(find_path(scenario.source->values, "objects.robots.type")->scalar, "pogobot");
    EXPECT_EQ(find_path(scenario.source->values, "objects.robots.radius")->scalar, "26.5");
    EXPECT_EQ(find_path(scenario.source->values, "objects.robots.msg_success_rate.alpha")->scalar, "1.03215183");
}

TEST(ValuesInUse, LeaveOutWhatMeansNothingInTheChosenMode) {
    Node const disk = robots_of("    geometry: disk\n");
    EXPECT_TRUE(has(disk, "radius"));
    EXPECT_FALSE(has(disk, "body_width"));
    EXPECT_TRUE(has(load("boundary_condition: solid\n").source->values, "wall_friction"));
    EXPECT_FALSE(has(load("boundary_condition: periodic\nwall_friction: 0.5\n").source->values, "wall_friction"));
}

TEST(ValuesInUse, NameTheSwitchesOfShadowsAndBlockedInfraredOnlyIfTheyAreNotAtTheirDefault) {
    struct Switch {
        std::string entry;  // where it stands; empty: at the top level
        std::string key;
        std::string default_value;
    };
    for (auto const& [entry, key, default_value] :
         {Switch{"", "walls_block_infrared", "false"}, Switch{"", "walls_block_light", "true"},
          Switch{"it", "blocks_infrared", "false"}, Switch{"it", "blocks_light", "true"},
          Switch{"robots", "blocks_light", "false"}, Switch{"lamp", "casts_shadows", "false"}}) {
        for (std::string const value : {"false", "true"}) {
            std::string const line = key + ": " + value;
            std::string text = entry.empty() ? line + "\n" : "";
            text += "objects:\n";
            for (std::string const own :
                 {"robots: {type: pogobot", "it: {type: passive_object", "lamp: {type: static_light"}) {
                text += "  " + own + ", geometry: disk, radius: 20";
                text += own.starts_with(entry + ":") ? ", " + line + "}\n" : "}\n";
            }
            Node const values = load(text).source->values;
            Node const& map = entry.empty() ? values : *find_path(values, "objects." + entry);
            EXPECT_EQ(has(map, key), value != default_value) << text;
        }
    }
}

TEST(ValuesInUse, HoldTheParametersOfTheReceptionLawThatIsChosen) {
    auto const keys = [](std::string const& map) {
        return keys_of(*robots_of("    msg_success_rate: " + map + "\n").find("msg_success_rate"));
    };
    EXPECT_EQ(keys("{type: static, alpha: 3}"), (std::vector<std::string>{"type", "rate"}));
    EXPECT_EQ(keys("{type: dynamic, alpha: 3}"), (std::vector<std::string>{"type", "alpha", "beta", "gamma", "delta"}));
    EXPECT_EQ(keys("{type: realistic}"), (std::vector<std::string>{"type", "alpha", "beta", "gamma", "delta"}));
    EXPECT_EQ(keys("{type: dynamic}"),
              (std::vector<std::string>{"type", "alpha", "beta", "gamma", "delta", "zeta", "theta"}));
}

TEST(ValuesInUse, GiveTheSameValuesForEveryConfigurationOfTheProject) {
    int count = 0;
    for (auto const& file : std::filesystem::directory_iterator(POGOSIM_SOURCE_DIR "/conf")) {
        if (file.path().extension() != ".yaml") {
            continue;
        }
        SCOPED_TRACE(file.path());
        expect_complete(load_scenario(file.path().string(), {.overrides = {}, .strict = false}, object_types()));
        ++count;
    }
    EXPECT_GT(count, 10);
}

TEST(ValuesInUse, GiveTheSameValuesForEveryTypeOfObject) {
    for (ObjectType const& type : object_types()) {
        SCOPED_TRACE(type.name);
        expect_complete(load("arena_file: a.csv\n" + kRobots + "  other:\n    geometry: disk\n    type: " +
                             std::string(type.name) + "\n    x: 100.1\n    y: -1.0e-20\n"));
    }
}

TEST(ValuesInUse, GiveTheSameRobotsForEveryModel) {
    for (std::string const model :
         {"motors: {}", "motors: {left: {linear_mm_s: 50, angular_rad_s: 1}}",
          "motors: {left: {linear_mm_s: 0, angular_rad_s: 1}, back: {}}\n    max_linear_speed: 3",
          "motors: {left: {linear_mm_s: 5, angular_rad_s: 1}, right: {forward: 1}}\n    max_linear_speed: 3",
          "faces: [{angle_deg: 10.5, reception_deg: 30, place: centre}]",
          "leds: []\n    light_sensors: [{place: [1, 2]}]",
          "battery: {capacity_mah: 3}\n    flash_pages: 3\n    processor: {clock_hz: 1000}"}) {
        SCOPED_TRACE(model);
        expect_complete(load("arena_file: a.csv\n" + kRobots + "    " + model + "\n"));
    }
}

TEST(ValuesInUse, HoldAKeyOfTwoNamesOnce) {
    Scenario const scenario = load("arena_file: a.csv\n" + kRobots +
                                   "    initial_formation: disk\n  lamp: {type: orbiting_static_light, "
                                   "geometry: disk, radius: 100, orbit_radius: 3, angular_speed: 2.5}\n");
    EXPECT_EQ(find_path(scenario.source->values, "objects.lamp.orbit_angular_speed")->scalar, "2.5");
    EXPECT_EQ(find_path(scenario.source->values, "objects.lamp.angular_speed"), nullptr);
    expect_complete(scenario);
}

TEST(ValuesInUse, GiveTheSameValuesForWhatIsNotOneNumber) {
    expect_complete(
        load("arena_file: a.csv\n"
             "arena_surface: file\nseed: 7\ndata_filename: 'a \"b\": #c'\ndata_logger_category: [robots, '7']\n"
             "parameters: {speed: [1, 2.50, three], name: '12'}\n"
             "objects:\n"
             "  robots:\n"
             "    - {type: pogobot, poses: [[0, 0, 0.1], [100, 0, 1.0e-7]]}\n"
             "    - {type: pogobot, nb: 3, area: {x: 200, y: 0, radius: 100}, initial_formation: disk}\n"
             "  '7': {type: passive_object, geometry: disk, initial_formation: random}\n"
             "  lamp: {type: static_light, geometry: global, photo_start_at: 3}\n"));
}

TEST(ValuesInUse, AreThoseThatSetHasSet) {
    EXPECT_EQ(
        find_path(load(kRobots, {.overrides = {"objects.robots.nb=12"}}).source->values, "objects.robots.nb")->scalar,
        "12");
}
