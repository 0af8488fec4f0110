// Robot models: the keys of a category, and files of `robot_model`.
#include "world/robot_model.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "config/source.hpp"
#include "config_file.hpp"
#include "lamps/lamp_types.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

RobotSpec robot(std::string const& lines) {
    return *load(kRobots + lines).objects.at(0).spec.robot;
}

/// The message behind the line number of a wrong key, which stands on line 6.
std::string error_in(std::string const& lines) {
    return load_error(kRobots + lines);
}

/// What each motor gives at full power forwards.
struct Twist {
    int motor;
    int forward;
    float linear_mm_s;
    float angular_rad_s;

    friend bool operator==(Twist const&, Twist const&) = default;
};
std::vector<Twist> twists(RobotSpec const& robot) {
    std::vector<Twist> all;
    for (Drive const& drive : robot.model.drives) {
        all.push_back({drive.motor, drive.forward, drive.linear * robot.max_linear_speed_mm_s,
                       drive.angular * robot.max_angular_speed_rad_s});
    }
    return all;
}

std::string bundled(std::string const& name) {
    return std::string(POGOSIM_SOURCE_DIR) + "/models/" + name + ".yaml";
}

TEST(RobotModel, BundledFilesSayWhatTheTypesHaveWithoutThem) {
    std::vector<std::pair<std::string, std::string>> const files{
        {"pogobot", "pogobot_wheels"}, {"pogobot", "pogobot_brushes"}, {"pogobject", "pogobject"},
        {"pogowall", "pogowall"},      {"membrane", "membrane"},       {"rectmembrane", "membrane"}};
    for (auto const& [type, file] : files) {
        std::string const text =
            "objects:\n  o: {type: " + type + ", geometry: disk, radius: 26.5, x: 100, y: 100, robot_model: ";
        Warnings const warnings;
        RobotSpec const without = *load(text + "~}\n").objects.at(0).spec.robot;
        RobotSpec const with = *load(text + bundled(file) + "}\n").objects.at(0).spec.robot;
        EXPECT_EQ(warnings.text(), "") << file;
        RobotModel same_motors = with.model;
        same_motors.drives = without.model.drives;
        EXPECT_EQ(same_motors, without.model) << file;
        EXPECT_EQ(twists(with), twists(without)) << file;
    }
    std::size_t bundled_files = 0;
    for (auto const& entry : std::filesystem::directory_iterator(std::string(POGOSIM_SOURCE_DIR) + "/models")) {
        bundled_files += entry.path().extension() == ".yaml" ? 1 : 0;
    }
    EXPECT_EQ(bundled_files, 5U);
}

TEST(RobotModel, PartsAreRead) {
    RobotModel const model = robot(
                                 "    faces: [{angle_deg: 90, place: centre, emission_deg: 30, reception_deg: 40}]\n"
                                 "    leds: [{place: [1, 2]}]\n"
                                 "    light_sensors: []\n"
                                 "    flash_pages: 16\n"
                                 "    processor: {clock_hz: 1000000, memory_bytes: 65536}\n")
                                 .model;
    ASSERT_EQ(model.faces.size(), 1U);
    EXPECT_EQ(model.faces[0].normal, (Vec2{0.0F, 1.0F}));
    EXPECT_EQ(model.faces[0].place, PartPlace());
    EXPECT_EQ(model.faces[0].emission_deg, 30.0F);
    EXPECT_EQ(model.faces[0].reception_deg, 40.0F);
    EXPECT_EQ(model.leds, (std::vector<Part>{{.direction = {1, 0}, .place = {.radii = {}, .offset_mm = {1, 2}}}}));
    EXPECT_TRUE(model.light_sensors.empty());
    EXPECT_EQ(model.flash_pages, 16U);
    EXPECT_EQ(model.processor.clock_hz, 1'000'000);
    EXPECT_EQ(model.processor.memory_bytes, 65'536);
    EXPECT_EQ(model.drives, two_wheels());  // as before
}

TEST(RobotModel, SpeedsAreThoseOfAllMotorsTogetherAndKeysScaleThem) {
    std::string const motors =
        "    motors:\n"
        "      right: {linear_mm_s: 30, angular_rad_s: -1}\n"
        "      left: {linear_mm_s: 30, angular_rad_s: 1}\n"
        "      back: {linear_mm_s: 20, forward: 1}\n";
    RobotSpec const own = robot(motors);
    EXPECT_FLOAT_EQ(own.max_linear_speed_mm_s, 80.0F);
    EXPECT_FLOAT_EQ(own.max_angular_speed_rad_s, 2.0F);
    EXPECT_EQ(twists(own), (std::vector<Twist>{{0, 0, 30, -1}, {1, 1, 30, 1}, {2, 1, 20, 0}}));
    // With motors, the keys are what their names say: the highest speed, and the fastest turn.
    EXPECT_EQ(twists(robot(motors + "    max_linear_speed: 160\n    max_angular_speed: 1\n")),
              (std::vector<Twist>{{0, 0, 60, -0.5F}, {1, 1, 60, 0.5F}, {2, 1, 40, 0}}));
    // Without, max_angular_speed has its old meaning: one motor alone turns the robot at twice this.
    EXPECT_EQ(twists(robot("    max_angular_speed: 1\n")), (std::vector<Twist>{{0, 0, 50, -2}, {1, 1, 50, 2}}));
    EXPECT_TRUE(robot("    motors: {}\n").model.drives.empty());
}

TEST(RobotModel, FileGivesKeysThatTheCategoryDoesNotHave) {
    Folder const folder;
    Folder::write("narrow.yaml", "radius: 30\ncommunication_radius: 55\nfaces: [{angle_deg: 0, emission_deg: 60}]\n");
    Folder::write("x.yaml",
                  "arena_file: arenas/disk.csv\nobjects:\n  robots: {type: pogobot, robot_model: narrow.yaml, "
                  "communication_radius: 70}\n");
    Scenario const scenario = load_scenario("x.yaml", {}, object_types());
    ObjectSpec const& spec = scenario.objects.at(0).spec;
    EXPECT_EQ(spec.shape.radius_mm, 30.0F);
    EXPECT_EQ(spec.robot->ir.range_mm, 70.0F);
    ASSERT_EQ(spec.robot->model.faces.size(), 1U);
    EXPECT_EQ(spec.robot->model.faces[0].emission_deg, 60.0F);
    ASSERT_EQ(scenario.object_files.size(), 1U);
    EXPECT_EQ(scenario.object_files[0].path, "narrow.yaml");
    // What the run keeps in its data file is complete without the model's file.
    Folder::write("resolved.yaml", to_yaml(scenario.source->values));
    std::filesystem::remove("narrow.yaml");
    ObjectSpec const again = load_scenario("resolved.yaml", {}, object_types()).objects.at(0).spec;
    EXPECT_EQ(again.robot->model, spec.robot->model);
    EXPECT_EQ(again.shape.radius_mm, 30.0F);
}

TEST(RobotModel, FileIsSearchedBesideTheConfigurationAndInThePathOfTheUser) {
    Folder const folder;
    std::filesystem::create_directories("conf");
    std::filesystem::create_directories("models_of_the_lab");
    Folder::write("conf/beside.yaml", "radius: 31\n");
    Folder::write("models_of_the_lab/far.yaml", "radius: 32\n");
    setenv("POGOSIM_PATH", "nowhere:models_of_the_lab", 1);
    Folder::write("conf/x.yaml",
                  "objects:\n"
                  "  a: {type: pogobot, robot_model: beside.yaml}\n"
                  "  b: {type: pogobot, robot_model: far.yaml}\n"
                  "  c: {type: pogobot, robot_model: models/pogobot_wheels.yaml}\n");
    Scenario const scenario = load_scenario("conf/x.yaml", {}, object_types());
    unsetenv("POGOSIM_PATH");
    EXPECT_EQ(scenario.objects.at(0).spec.shape.radius_mm, 31.0F);
    EXPECT_EQ(scenario.objects.at(1).spec.shape.radius_mm, 32.0F);
    EXPECT_EQ(scenario.objects.at(2).spec.shape.radius_mm, 26.5F);
}

TEST(RobotModel, MistakesNameTheFileAndTheLineOfTheModel) {
    Folder const folder;
    Folder::write("x.yaml", "objects:\n  robots: {type: pogobot, robot_model: m.yaml}\n");
    auto const error = [](std::string const& model) {
        Folder::write("m.yaml", model);
        return error_of([] { load_scenario("x.yaml", {}, object_types()); });
    };
    EXPECT_EQ(error("radius: 30\nfaces: []\n"), "m.yaml:2: objects.robots.faces: expected 1 to 4 entries, found 0");
    EXPECT_EQ(error("faces:\n  - {angle_deg: 0}\n  - {angle_deg: 10, emission_deg: 200}\n"),
              "m.yaml:3: objects.robots.faces.1.emission_deg: expected a number above 0, at most 180 (degrees), found "
              "200");
    EXPECT_EQ(error("type: pogobot\n"),
              "m.yaml:1: type: a robot model says what robots have, not which there are or where; move this key into "
              "the category that names the model");
    EXPECT_EQ(error("robot_model: other.yaml\n"),
              "m.yaml:1: robot_model: a robot model cannot name another one; copy the keys of that one into this file");
    EXPECT_NE(error("faces: [").find("m.yaml"), std::string::npos);
    std::filesystem::remove("m.yaml");
    EXPECT_EQ(error_of([] { load_scenario("x.yaml", {}, object_types()); })
                  .find("x.yaml:2: objects.robots.robot_model: there is no file "
                        "'m.yaml'; searched "),
              0U);
    Warnings const warnings;
    Folder::write("m.yaml", "radius: 30\nfacess: [{angle_deg: 0}]\n");
    load_scenario("x.yaml", {}, object_types());
    EXPECT_NE(warnings.text().find("m.yaml:2: "), std::string::npos);
    EXPECT_NE(warnings.text().find("'faces'"), std::string::npos);
}

TEST(RobotModel, FileWithoutKeysIsToldWhatARobotModelHolds) {
    Folder const folder;
    Folder::write("x.yaml", "objects:\n  robots: {type: pogobot, robot_model: m.yaml}\n");
    std::string const content =
        " is empty; a robot model holds keys of a category, such as radius: 26.5, communication_radius: 80, faces or "
        "motors";
    for (auto const& [text, what] :
         {std::pair{"", "m.yaml: the file"}, {"# later\n", "m.yaml: the file"}, {"{}\n", "m.yaml:1: the map"}}) {
        Folder::write("m.yaml", text);
        EXPECT_EQ(error_of([] { load_scenario("x.yaml", {}, object_types()); }), what + content);
    }
}

TEST(RobotModel, FileOfWhichNothingCountsIsWarnedOf) {
    Folder const folder;
    Folder::write("m.yaml", "radius: 30\ncommunication_radius: 55\n");
    Folder::write("x.yaml", "objects:\n  robots: {type: pogobot, robot_model: m.yaml, communication_radius: 70}\n");
    Warnings const warnings;
    load_scenario("x.yaml", {}, object_types());  // gives the radius
    EXPECT_EQ(warnings.text(), "");
    load_scenario("x.yaml", {.overrides = {"objects.robots.radius=26.5"}}, object_types());
    EXPECT_EQ(warnings.text(),
              "x.yaml:2: objects.robots.robot_model: 'm.yaml' changes nothing, since the category has radius, "
              "communication_radius itself; remove there what the model is to give\n");
}

TEST(RobotModel, FolderInPlaceOfAFileIsRefusedWithItsLine) {
    EXPECT_NE(error_in("    robot_model: .\n").find("'.' is a folder; expected a YAML file"), std::string::npos);
    EXPECT_NE(error_in("    robot_model: .\n").find("objects.robots.robot_model"), std::string::npos);
    EXPECT_NE(error_in("    function_costs: .\n").find("'.' is a folder; expected a YAML file"), std::string::npos);
    EXPECT_EQ(error_in("    brain: {firmware: .}\n"),
              "x.yaml:6: objects.robots.brain.firmware: '.' is a folder; expected an ELF file");
    Folder const folder;
    std::filesystem::create_directory("robot.elf");
    EXPECT_EQ(error_in("    brain: robot.elf\n"),
              "x.yaml:6: objects.robots.brain: 'robot.elf' is a folder; expected an ELF file");
}

TEST(RobotModel, FractionsOfWhatTheRobotHasAsWholeNumbersAreRefused) {
    std::vector<std::pair<std::string, std::string>> const values{
        {"processor: {cycles: {cache_miss: 1.5}}", "processor.cycles.cache_miss: expected an integer from 0 to 1000"},
        {"processor: {cycles: {shift_further_bit: 0.5}}", "processor.cycles.shift_further_bit: expected an integer"},
        {"processor: {cycles: {load: 3.2}}", "processor.cycles.load: expected an integer from 1 to 1000 (cycles)"},
        {"processor: {clock_hz: 1.5}", "processor.clock_hz: expected an integer from 1 to"},
        {"processor: {memory_bytes: 2048.5}", "processor.memory_bytes: expected an integer from 1024 to"},
        {"flash_pages: 10.5", "flash_pages: expected an integer from 0 to 5888"},
        {"motors: {left: {forward: 0.5}}", "motors.left.forward: expected an integer from 0 to 1"},
    };
    for (auto const& [line, what] : values) {
        EXPECT_EQ(error_in("    " + line + "\n").find("x.yaml:6: objects.robots." + what), 0U) << line;
    }
    Warnings const warnings;
    EXPECT_EQ(robot("    processor: {cycles: {cache_miss: 2.0}}\n").model.processor.cycles.cache_miss, 2U);
    EXPECT_EQ(warnings.text(), "");
}

TEST(RobotModel, WrongPartsAreRefused) {
    EXPECT_EQ(error_in("    faces: [1]\n"), "x.yaml:6: objects.robots.faces.0: expected a map of keys, found 1");
    EXPECT_NE(error_in("    faces: {angle_deg: 0}\n").find("expected a list of maps"), std::string::npos);
    EXPECT_NE(error_in("    faces: [{}, {}, {}, {}, {}]\n").find("expected 1 to 4 entries, found 5"),
              std::string::npos);
    EXPECT_NE(error_in("    leds: [{}, {}, {}, {}, {}, {}]\n").find("expected 0 to 5 entries, found 6"),
              std::string::npos);
    EXPECT_NE(error_in("    light_sensors: [{}, {}, {}, {}]\n").find("expected 0 to 3 entries, found 4"),
              std::string::npos);
    EXPECT_NE(error_in("    leds: [{place: edge}]\n").find("expected rim, centre, or [x, y]"), std::string::npos);
    EXPECT_NE(error_in("    leds: [{place: [1, 2, 3]}]\n").find("place"), std::string::npos);
    EXPECT_NE(error_in("    motors: {left: {forward: 2}}\n").find("motors.left.forward"), std::string::npos);
    EXPECT_EQ(error_in("    motors: {rigt: {linear_mm_s: 50}}\n"),
              "x.yaml:6: objects.robots.motors.rigt: expected one of right, left, back; did you mean 'right'?");
    EXPECT_NE(error_in("    motors: 3\n").find("expected a map of motors"), std::string::npos);
    EXPECT_NE(error_in("    flash_pages: 5889\n").find("flash_pages: expected an integer from 0 to 5888"),
              std::string::npos);
    EXPECT_NE(error_in("    processor: {memory_bytes: 1}\n").find("processor.memory_bytes"), std::string::npos);
    EXPECT_NE(load_error("objects:\n  w: {type: pogowall, geometry: arena, faces: [{}]}\n").find("have no faces"),
              std::string::npos);
    EXPECT_NE(load_error("objects:\n  w: {type: pogowall, geometry: arena, motors: {left: {linear_mm_s: 50}}}\n")
                  .find("have no motors"),
              std::string::npos);
}

TEST(RobotModel, FacesWhoseAnglesWereForgottenAreRefused) {
    std::string const text = "is where face 0 is, and looks the same way; give it an `angle_deg` of its own";
    EXPECT_EQ(error_in("    faces: [{}, {}]\n"), "x.yaml:6: objects.robots.faces.1: " + text);
    EXPECT_EQ(error_in("    faces: [{angle_deg: 0}, {angle_deg: 90}, {angle_deg: 360}]\n"),
              "x.yaml:6: objects.robots.faces.2: " + text);
    EXPECT_EQ(robot("    faces: [{place: [9, 5]}, {place: [9, -5]}]\n").model.faces.size(), 2U);
    EXPECT_EQ(robot("    faces: [{place: centre}, {place: centre, angle_deg: 90}]\n").model.faces.size(), 2U);
    Warnings const warnings;
    robot("    leds: [{angle: 90}]\n");
    EXPECT_EQ(warnings.text(),
              "x.yaml:6: unknown key 'objects.robots.leds.0.angle' is ignored; did you mean 'angle_deg'?\n");
}

TEST(RobotModel, AnglesInRadiansAreTold) {
    Warnings const warnings;
    robot("    faces: [{angle_deg: 0}, {angle_deg: 1.5708}, {angle_deg: 3.14159, reception_deg: 2.1}]\n");
    EXPECT_EQ(warnings.text(),
              "x.yaml:6: objects.robots.faces.1.angle_deg: 1.5708 degrees is unusually small, like 2 other numbers of "
              "this list; if you meant radians, write 90.0002\n");
    robot("    faces: [{angle_deg: 0}, {angle_deg: 5}, {angle_deg: 22.5}]\n");
    EXPECT_EQ(warnings.lines().size(), 1U);
}

TEST(RobotModel, PartsOutsideOfTheBodyAreTold) {
    Warnings const warnings;
    robot("    leds: [{place: [18.75, 18.75]}, {place: [40, 30]}, {angle_deg: 90}]\n");
    EXPECT_EQ(warnings.text(),
              "x.yaml:6: objects.robots.leds.1.place: is 50 mm from the centre, outside of the body, whose radius is "
              "26.5 mm\n");
}

TEST(RobotModel, SpeedsOfTheCategoryAreToldWhatTheyMeanWithTheMotorsOfAFile) {
    Warnings const warnings;
    robot(
        "    motors: {left: {linear_mm_s: 5, angular_rad_s: 2}}\n    max_angular_speed: 1\n    max_linear_speed: 9\n");
    Folder const folder;
    Folder::write("m.yaml",
                  "motors: {left: {linear_mm_s: 10, angular_rad_s: 2}, right: {linear_mm_s: -10, "
                  "angular_rad_s: -2}}\n");
    Folder::write("x.yaml", "objects:\n  robots: {type: pogobot, robot_model: m.yaml}\n");
    auto const robot_with = [](std::vector<std::string> const& overrides) {
        return *load_scenario("x.yaml", {.overrides = overrides}, object_types()).objects[0].spec.robot;
    };
    robot_with({});
    robot_with({"objects.robots.max_angular_speed=4", "objects.robots.max_linear_speed=20"});  // as the motors say
    EXPECT_EQ(warnings.text(), "");
    robot_with({"objects.robots.max_angular_speed=2"});
    robot_with({"objects.robots.max_linear_speed=100"});
    EXPECT_EQ(warnings.text(),
              "--set: objects.robots.max_angular_speed: with `motors` (m.yaml:1), this is the fastest turn, 2 rad/s; "
              "without them, it would be 8 rad/s. Remove it to turn as fast as the motors say, 4 rad/s\n"
              "--set: objects.robots.max_linear_speed: with `motors` (m.yaml:1), this is the top speed, 100 mm/s. "
              "Remove it to move as fast as the motors say, 20 mm/s\n");
}

TEST(RobotModel, NoKeyMovesWhatTheMotorsDoNotMove) {
    Warnings const warnings;
    RobotSpec const turning =
        robot("    motors: {left: {linear_mm_s: 0, angular_rad_s: 2}}\n    max_linear_speed: 300\n");
    RobotSpec const straight =
        robot("    motors: {left: {linear_mm_s: 50, angular_rad_s: 0}}\n    max_angular_speed: 2\n");
    EXPECT_EQ(turning.max_linear_speed_mm_s, 0.0F);
    EXPECT_EQ(straight.max_angular_speed_rad_s, 0.0F);
    EXPECT_EQ(
        warnings.text(),
        "x.yaml:7: objects.robots.max_linear_speed: has no effect, since the `motors` (x.yaml:6) do not move the "
        "robot\n"
        "x.yaml:7: objects.robots.max_angular_speed: has no effect, since the `motors` (x.yaml:6) do not turn the "
        "robot\n");
}

TEST(RobotModel, MotorsWithoutASpeedAreWarnedOf) {
    for (auto const& [motors, said] : std::vector<std::pair<std::string, std::string>>{
             {"{left: {linear_mm_s: 60}}",
              "x.yaml:6: objects.robots.motors: none of these motors has a value of `angular_rad_s`, so they cannot "
              "turn the robot; a map of motors replaces the whole one of the robot's type or model. Write "
              "angular_rad_s: 0 in one of them if that is meant\n"},
             {"{back: {angular_rad_s: 1}}",
              "x.yaml:6: objects.robots.motors: none of these motors has a value of `linear_mm_s`, so they cannot move "
              "the robot; a map of motors replaces the whole one of the robot's type or model. Write linear_mm_s: 0 in "
              "one of them if that is meant\n"},
             {"{left: {linear_mm_s: 60, angular_rad_s: 0}, right: {}}", ""},
             {"{}", ""}}) {
        SCOPED_TRACE(motors);
        Warnings const warnings;
        robot("    motors: " + motors + "\n");
        EXPECT_EQ(warnings.text(), said);
    }
}

TEST(RobotModel, PartsWithoutAValueAreWarnedOf) {
    for (std::string const key : {"faces", "leds", "light_sensors", "motors", "processor", "battery",
                                  "msg_success_rate", "function_costs", "brain", "poses"}) {
        SCOPED_TRACE(key);
        Warnings const warnings;
        robot("    " + key + ":\n");
        EXPECT_NE(warnings.text().find("x.yaml:6: objects.robots." + key + ": expected "), std::string::npos)
            << warnings.text();
        EXPECT_NE(warnings.text().find(", found nothing; the default is used"), std::string::npos);
    }
    EXPECT_EQ(
        error_of([] { robot("    motors:\n      left:\n      right: {linear_mm_s: 1, angular_rad_s: 1}\n"); }),
        "x.yaml:7: objects.robots.motors.left: expected a map, such as {linear_mm_s: 50, angular_rad_s: 2}, found "
        "nothing; remove a motor that is not there");
}

TEST(RobotModel, WithoutItsKeysNothingIsAddedToTheRunsConfiguration) {
    Scenario const scenario = load(kRobots);
    Node const& values = scenario.source->values;
    for (char const* const key :
         {"faces", "leds", "light_sensors", "motors", "flash_pages", "processor", "robot_model"}) {
        EXPECT_EQ(find_path(values, std::string("objects.robots.") + key), nullptr) << key;
    }
}

TEST(RobotModel, RightAnglesAreExact) {
    EXPECT_EQ(direction_of_deg(0.0), (Vec2{1, 0}));
    EXPECT_EQ(direction_of_deg(-270.0), (Vec2{0, 1}));
    EXPECT_EQ(direction_of_deg(540.0), (Vec2{-1, 0}));
    EXPECT_EQ(direction_of_deg(-90.0), (Vec2{0, -1}));
    EXPECT_FLOAT_EQ(direction_of_deg(30.0).y, 0.5F);
}

}  // namespace
