#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "config/scenario.hpp"
#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

std::vector<std::string> warnings_of(std::string const& text) {
    Warnings const warnings;
    load(text);
    return warnings.lines();
}

using Lines = std::vector<std::string>;

}  // namespace

TEST(UnknownKey, WarnsOnceAndNamesTheNearestKey) {
    EXPECT_EQ(warnings_of(kRobots + "    radus: 3\n"),
              Lines{"x.yaml:6: unknown key 'objects.robots.radus' is ignored; did you mean 'radius'?"});
    EXPECT_EQ(warnings_of(kRobots + "simulation_tme: 3\n"),
              Lines{"x.yaml:6: unknown key 'simulation_tme' is ignored; did you mean 'simulation_time'?"});
    EXPECT_EQ(warnings_of(kRobots + "    msg_success_rate: {type: static, rat: 1}\n"),
              Lines{"x.yaml:6: unknown key 'objects.robots.msg_success_rate.rat' is ignored; did you mean 'rate'?"});
}

TEST(UnknownKey, WithoutALikeKeyNamesNone) {
    EXPECT_EQ(warnings_of(kRobots + "qwertzuiop: 3\n"), Lines{"x.yaml:6: unknown key 'qwertzuiop' is ignored"});
}

TEST(UnknownKey, NearestKeyIsOneOfTheSameObjectType) {
    EXPECT_EQ(warnings_of(kRobots + "    photo_start_at: 3\n"),
              Lines{"x.yaml:6: unknown key 'objects.robots.photo_start_at' is ignored"});
    EXPECT_EQ(warnings_of(kLamp + "    photo_start_att: 3\n"),
              Lines{"x.yaml:6: unknown key 'objects.lamp.photo_start_att' is ignored; did you mean 'photo_start_at'?"});
}

TEST(UnknownKey, OldNamesAreToldTheirNewOnes) {
    EXPECT_EQ(warnings_of(kRobots + "nBots: 3\n"),
              Lines{"x.yaml:6: unknown key 'nBots' is ignored; it is now 'objects.<category>.nb'"});
    for (char const* old :
         {"commRadius", "msgSuccessRate", "robot_radius", "initial_robot_formation", "initial_light_value", "showComms",
          "simulationTime", "timeStep", "photo_start_at", "photo_start_duration"}) {
        Lines const lines = warnings_of(kRobots + old + ": 3\n");
        ASSERT_EQ(lines.size(), 1U) << old;
        EXPECT_NE(lines[0].find("it is now '"), std::string::npos) << old;
    }
}

TEST(UnknownKey, NothingUnderParametersIsUnknown) {
    EXPECT_TRUE(warnings_of(kRobots + "parameters: {radus: 1, p: {q: 2}}\noptimization: {any: thing}\n").empty());
}

TEST(UnknownKey, IsAnErrorWhenStrict) {
    EXPECT_EQ(load_error(kRobots + "    radus: 3\n", {.overrides = {}, .strict = true}),
              "x.yaml:6: unknown key 'objects.robots.radus'; did you mean 'radius'? (--strict)");
    EXPECT_EQ(load_error(kRobots + "    msg_success_rate: {type: static, rat: 1}\n", {.overrides = {}, .strict = true}),
              "x.yaml:6: unknown key 'objects.robots.msg_success_rate.rat'; did you mean 'rate'? (--strict)");
    EXPECT_EQ(load_error(kRobots, {.overrides = {"objects.robots.radus=3"}, .strict = true}),
              "--set: unknown key 'objects.robots.radus'; did you mean 'radius'? (--strict)");
}

TEST(UnknownKey, OfOverridesMayBeAnErrorAlone) {
    LoadOptions const options{.overrides = {"objects.robots.radus=3"}, .strict_overrides = true};
    EXPECT_EQ(load_error(kRobots, options), "--set: unknown key 'objects.robots.radus'; did you mean 'radius'?");
    Warnings const warnings;
    load(kRobots + "    radus: 3\n", {.overrides = {"objects.robots.nb=2"}, .strict_overrides = true});
    EXPECT_EQ(warnings.text(), "x.yaml:6: unknown key 'objects.robots.radus' is ignored; did you mean 'radius'?\n");
}

TEST(UnknownKey, PlaceOneLevelFurtherInIsNamed) {
    std::string const text = kRobots + "parameters: {turn_duration: 300, walk: {speed: 1}}\n";
    auto const warnings_of_set = [&text](std::string const& assignment) {
        Warnings const warnings;
        load(text, {.overrides = {assignment}});
        return warnings.text();
    };
    auto const expected = [](std::string const& key, std::string const& place) {
        return "--set: unknown key '" + key + "' is ignored; did you mean '" + place + "'?\n";
    };
    EXPECT_EQ(warnings_of_set("robots.nb=5"), expected("robots", "objects.robots.nb"));
    EXPECT_EQ(warnings_of_set("robots.msg_success_rate.rate=1"),
              expected("robots", "objects.robots.msg_success_rate.rate"));
    EXPECT_EQ(warnings_of_set("robots={nb: 5, radius: 30}"), expected("robots", "objects.robots"));
    EXPECT_EQ(warnings_of_set("turn_duration=400"), expected("turn_duration", "parameters.turn_duration"));
    EXPECT_EQ(warnings_of_set("walk.speed=2"), expected("walk", "parameters.walk.speed"));
    EXPECT_EQ(load_error(text, {.overrides = {"robots.nb=5"}, .strict = true}),
              "--set: unknown key 'robots'; did you mean 'objects.robots.nb'? (--strict)");
    EXPECT_EQ(warnings_of(kRobots + "others: {type: pogobot, nb: 3}\n"),
              Lines{"x.yaml:6: unknown key 'others' is ignored; did you mean 'objects.others'?"});
}

TEST(UnknownKey, LevelThatHasItIsNamed) {
    for (std::string const key : {"sensor_model", "imu_gravity", "battery", "photosensors_bits", "radius"}) {
        EXPECT_EQ(warnings_of(kRobots + key + ": 5\n"),
                  Lines{"x.yaml:6: unknown key '" + key + "' is ignored; it belongs in a category, as objects.robots." +
                        key});
    }
    EXPECT_EQ(warnings_of(kRobots + "light_mode: gradient\n"),
              Lines{"x.yaml:6: unknown key 'light_mode' is ignored; it belongs in a category, as "
                    "objects.<category>.light_mode"});
    for (std::string const key : {"magnetometer", "flash_state", "view", "time_step"}) {
        EXPECT_EQ(warnings_of(kRobots + "    " + key + ": {}\n"),
                  Lines{"x.yaml:6: unknown key 'objects.robots." + key + "' is ignored; it belongs at the top level"});
    }
    EXPECT_EQ(load_error(kRobots + "battery: {capacity_mah: 3}\n", {.overrides = {}, .strict = true}),
              "x.yaml:6: unknown key 'battery'; it belongs in a category, as objects.robots.battery (--strict)");
}

TEST(UnknownKey, MapOfACategoryAtTheTopLevelIsNoCategory) {
    EXPECT_EQ(warnings_of(kRobots + "msg_success_rate: {type: static, rate: 1}\n"),
              Lines{"x.yaml:6: unknown key 'msg_success_rate' is ignored; it belongs in a category, as "
                    "objects.robots.msg_success_rate"});
}

TEST(UnknownKey, PlaceInTheMapOfASensorIsNamed) {
    auto const expect = [](std::string const& text, std::string const& key, std::string const& place) {
        EXPECT_EQ(warnings_of(kRobots + text),
                  Lines{"x.yaml:" + std::string(text.find('\n') + 1 < text.size() ? "7" : "6") + ": unknown key '" +
                        key + "' is ignored; did you mean '" + place + "'?"});
    };
    expect("magnetometer:\n  noise_stddev: {x: [3]}\n", "magnetometer.noise_stddev",
           "magnetometer.robot_variation.noise_stddev");
    expect("magnetometer:\n  procedural: {minor_radius: [3]}\n", "magnetometer.procedural.minor_radius",
           "magnetometer.procedural.ellipse.minor_radius");
    expect("magnetometer:\n  procedural: {timing: robot}\n", "magnetometer.procedural.timing", "magnetometer.timing");
    expect("timing: robot\n", "timing", "magnetometer.timing");
    expect("input_file: a.flash\n", "input_file", "flash_state.input_file");
    expect("    capacity_mah: 20\n", "objects.robots.capacity_mah", "objects.robots.battery.capacity_mah");
    // It may be in several places, stand deeper, or in a map that these objects have not.
    EXPECT_EQ(warnings_of(kLamp + "    capacity_mah: 20\n"),
              Lines{"x.yaml:6: unknown key 'objects.lamp.capacity_mah' is ignored"});
    EXPECT_EQ(warnings_of(kRobots + "magnetometer: {z: 1}\n"),
              Lines{"x.yaml:6: unknown key 'magnetometer.z' is ignored"});
    EXPECT_EQ(warnings_of(kRobots + "noise_stddev: 1\n"), Lines{"x.yaml:6: unknown key 'noise_stddev' is ignored"});
}

TEST(UnknownKey, KeyOfTheTopLevelIsNoCategory) {
    std::string const what = ": this is no category of objects; it belongs at the top level";
    EXPECT_EQ(load_error(kRobots + "  magnetometer: {source: csv}\n"), "x.yaml:6: objects.magnetometer" + what);
    EXPECT_EQ(load_error(kRobots + "  simulation_time: 3\n"), "x.yaml:6: objects.simulation_time" + what);
    EXPECT_EQ(load_error(kRobots, {.overrides = {"objects.flash_state.input_file=a"}}),
              "--set: objects.flash_state" + what);
    EXPECT_EQ(warnings_of(kRobots + "  flash: {type: static_light, geometry: global}\n"), Lines{});
}

TEST(UnknownKey, BracesAndPercentSignsInItAreShownAsTheyAre) {
    EXPECT_EQ(warnings_of(kRobots + "'{}%s': 3\n"), Lines{"x.yaml:6: unknown key '{}%s' is ignored"});
}

TEST(UnknownKey, NamesThatBatchToolsWriteAreKnown) {
    EXPECT_EQ(warnings_of("_batch_choice_names: {objects.robots: size}\n" + kRobots), Lines{});
    EXPECT_EQ(warnings_of("size: big\n_batch_choice_names: {objects.robots: size}\n" + kRobots), Lines{});
    EXPECT_EQ(warnings_of("size: big\n_batch_choice_names: [size]\n" + kRobots), Lines{});
    EXPECT_EQ(warnings_of("size: big\nresult_filename_format: 'result_{size}_{seed:02d}.feather'\n" + kRobots),
              Lines{});
    EXPECT_EQ(warnings_of("size: big\nresult_new_columns: [arena_file, size]\n" + kRobots), Lines{});
    EXPECT_EQ(warnings_of("size: big\n" + kRobots +
                          "    batch_hierarchical_options: {name: size, default: {radius: 20}, big: {radius: 40}}\n"),
              Lines{});
    EXPECT_EQ(warnings_of(kRobots + "    _batch_choice_names: [a]\n"), Lines{});
    EXPECT_EQ(warnings_of("size: big\n" + kRobots).size(), 1U);
}

namespace {

std::string const kTwo =
    kRobots + "  wall: {type: pogowall, geometry: arena}\n  lamp: {type: static_light, geometry: global}\n";

}  // namespace

TEST(UnknownCategoryToRecord, WarnsAndNamesTheNearest) {
    std::string const known = "is ignored; the categories with rows in the data file are robots, wall";
    EXPECT_EQ(warnings_of(kTwo + "data_logger_category: [robot, wall]\n"),
              Lines{"x.yaml:8: data_logger_category: 'robot' " + known + "; did you mean 'robots'?"});
    EXPECT_EQ(warnings_of(kTwo + "data_logger_category: [robots, lamp]\n"),
              Lines{"x.yaml:8: data_logger_category: 'lamp' " + known});
    EXPECT_EQ(warnings_of(kTwo + "data_logger_category: [wall]\n"), Lines{});
}

TEST(UnknownCategoryToRecord, AloneItIsAnErrorSinceNoRowsWouldBeLeft) {
    std::string const expected =
        "x.yaml:8: data_logger_category: expected at least one of the categories with rows in the data file, "
        "robots, wall; found ";
    std::string const all = " (without this key, all are recorded)";
    EXPECT_EQ(load_error(kTwo + "data_logger_category: [robot]\n"), expected + "'robot'; did you mean 'robots'?" + all);
    EXPECT_EQ(load_error(kTwo + "data_logger_category: [lamp, light]\n"), expected + "'lamp'" + all);
    EXPECT_EQ(load_error(kTwo + "data_logger_category: []\n"), expected + "none" + all);
}

TEST(UnknownCategoryToRecord, DoesNotMatterWithoutADataFile) {
    EXPECT_EQ(warnings_of(kTwo + "enable_data_logging: false\ndata_logger_category: [robot]\n"), Lines{});
}

TEST(UnknownCategoryToRecord, CategoryWithoutObjectsIsKnown) {
    EXPECT_EQ(warnings_of(kTwo + "  others: {type: pogobot, nb: 0}\ndata_logger_category: [others]\n"), Lines{});
}
