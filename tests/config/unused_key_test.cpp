// Keys that mean nothing in the mode that a configuration chose: any value of their type is accepted there.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

struct Case {
    std::string used;    // lines of a configuration in whose mode the last key counts
    std::string unused;  // lines that choose another mode
    std::string key;     // with a value out of its range, behind either
    std::string wrong;   // the key with a value of another type
};

std::string const kThing = "objects:\n  robots: {type: pogobot}\n  it:\n    ";

std::vector<Case> const kCases{
    {"initial_formation: chessboard", "initial_formation: random", "chessboard_distance_between_neighbors: 0",
     "chessboard_distance_between_neighbors: far"},
    {"initial_formation: aligned_lattice", "initial_formation: disk", "lattice_distance_between_neighbors: 0",
     "lattice_distance_between_neighbors: far"},
    {"initial_formation: random", "initial_formation: disk", "formation_attempts_per_point: 0",
     "formation_attempts_per_point: few"},
    {"initial_formation: random_near_walls", "initial_formation: lloyd", "formation_max_restarts: -1",
     "formation_max_restarts: none"},
    {"initial_formation: aligned_random", "initial_formation: power_lloyd", "formation_max_space_between_neighbors: 0",
     "formation_max_space_between_neighbors: wide"},
    {"initial_formation: aligned_disk", "initial_formation: random", "initial_formation_center: [1e9, 0]",
     "initial_formation_center: middle"},
    {"initial_formation: imported\nformation_filename: f.csv", "initial_formation: random",
     "imported_formation_min_coords: [.inf, 0]", "imported_formation_min_coords: all"},
    {"boundary_condition: solid", "boundary_condition: periodic", "wall_restitution: 18", "wall_restitution: high"},
    {"boundary_condition: solid", "boundary_condition: periodic", "wall_friction: -1", "wall_friction: low"},
    {"enable_data_logging: true", "enable_data_logging: false", "data_logger_flush_row_count: 0",
     "data_logger_flush_row_count: all"},
    {"enable_data_logging: true", "enable_data_logging: false", "save_data_period: .inf", "save_data_period: never"},
    {"enable_data_logging: true", "enable_data_logging: false", "save_data_period: 1e-300", "save_data_period: never"},
    {"GUI: true", "GUI: false", "GUI_speed_up: -1", "GUI_speed_up: slow"},
    {kThing + "type: pogobot\n    msg_success_rate:\n      type: static",
     kThing + "type: pogobot\n    msg_success_rate:\n      type: dynamic", "      rate: 2", "      rate: often"},
    {kThing + "type: pogobot\n    msg_success_rate:\n      type: static",
     kThing + "type: pogobot\n    msg_success_rate:\n      type: realistic", "      rate: -1", "      rate: [1]"},
    {kThing + "type: passive_object\n    geometry: disk", kThing + "type: passive_object\n    geometry: rectangle",
     "    radius: 0", "    radius: small"},
    {kThing + "type: pogobot\n    geometry: rectangle", kThing + "type: pogobot", "    body_width: -1",
     "    body_width: wide"},
    {kThing + "type: static_light\n    geometry: triangle", kThing + "type: static_light\n    geometry: global",
     "    side_length: 0", "    side_length: long"},
    {kThing + "type: static_light\n    geometry: disk", kThing + "type: static_light\n    geometry: arena",
     "    x: 1e9", "    x: left"},
    {kThing + "type: static_light\n    geometry: disk\n    light_mode: gradient",
     kThing + "type: static_light\n    geometry: disk", "    edge_value: -1", "    edge_value: dark"},
    {kThing + "type: static_light\n    geometry: disk\n    light_mode: gradient",
     kThing + "type: static_light\n    geometry: disk\n    light_mode: plane", "    gradient_radius: 1e9",
     "    gradient_radius: far"},
    {kThing + "type: static_light\n    geometry: disk\n    light_mode: plane",
     kThing + "type: static_light\n    geometry: disk\n    light_mode: gradient", "    plane_half_span: 0",
     "    plane_half_span: none"},
    {kThing + "type: static_light\n    geometry: disk\n    photo_start_at: 1",
     kThing + "type: static_light\n    geometry: disk", "    photo_start_duration: -1",
     "    photo_start_duration: short"},
    {kThing + "type: rotating_ray_of_light\n    geometry: disk\n    photo_start_at: 1",
     kThing + "type: rotating_ray_of_light\n    geometry: disk", "    photo_start_duration: -1",
     "    photo_start_duration: short"},
    {kThing + "type: orbiting_static_light\n    geometry: disk\n    orbit_radius: 5",
     kThing + "type: orbiting_static_light\n    geometry: disk", "    orbit_phase: 1e9", "    orbit_phase: up"},
    {kThing + "type: pogowall\n    geometry: disk\n    y: 1", kThing + "type: pogowall\n    geometry: arena",
     "    x: 1e9", "    x: left"},
    {kThing + "type: pogobot", kThing + "type: active_object\n    geometry: disk", "    max_linear_speed: -1",
     "    max_linear_speed: fast"},
    {kThing + "type: rectmembrane\n    geometry: disk",
     kThing + "type: rectmembrane\n    geometry: disk\n    rect_thickness: 1", "    dot_radius: 0",
     "    dot_radius: small"},
};

}  // namespace

TEST(UnusedKey, OutOfRangeValueIsRefusedOnlyInTheModeThatReadsIt) {
    Warnings const ignored;
    for (Case const& one : kCases) {
        bool const is_top = one.used.find("objects:") == std::string::npos;
        std::string const tail = "\n" + one.key + "\n" + (is_top ? kRobots : "");
        EXPECT_NE(load_error(one.used + tail), "no error") << one.used << tail;
        EXPECT_EQ(load_error(one.unused + tail), "no error") << one.unused << tail;
    }
}

TEST(UnusedKey, WrongTypeIsRefusedInEveryMode) {
    Warnings const ignored;
    for (Case const& one : kCases) {
        bool const is_top = one.used.find("objects:") == std::string::npos;
        std::string const tail = "\n" + one.wrong + "\n" + (is_top ? kRobots : "");
        EXPECT_NE(load_error(one.used + tail).find("expected"), std::string::npos) << one.used << tail;
        EXPECT_NE(load_error(one.unused + tail).find("expected"), std::string::npos) << one.unused << tail;
    }
}

TEST(UnusedKey, FilesThatNothingReadsOrWritesNeedNoName) {
    Warnings const ignored;
    EXPECT_EQ(load_error(kRobots + "enable_data_logging: false\ndata_filename: ''\n"), "no error");
    EXPECT_EQ(load_error(kRobots + "enable_console_logging: false\nconsole_filename: ''\n"), "no error");
    EXPECT_EQ(load_error(kRobots + "formation_filename: ''\n"), "no error");
    EXPECT_EQ(load_error(kRobots + "message_log: ''\n"), "no error");
    EXPECT_EQ(load_error(kRobots + "message_log:\n"), "no error");
    EXPECT_EQ(load_error(kRobots + "save_video_period: -1\nframes_name: same.png\n"), "no error");
}

TEST(UnusedKey, WallOfTheArenaNeedsNeitherOfXAndY) {
    Warnings const ignored;
    Scenario const s = load(kThing + "type: pogowall\n    geometry: arena\n    x: 5\n");
    EXPECT_FALSE(s.objects.at(1).position_mm);
}

namespace {

std::string warnings_of_lamp(std::string const& type, std::string const& keys) {
    Warnings const warnings;
    load(kThing + "type: " + type + "\n" + keys);
    return warnings.text();
}

}  // namespace

TEST(UnusedKey, KeysOfAGradientOrPlaneWithoutALightModeWarn) {
    std::string const disk = "    geometry: disk\n";
    std::string const rest = " no effect with light_mode static, the default; set light_mode to gradient or plane\n";
    for (std::string const type : {"static_light", "orbiting_static_light"}) {
        EXPECT_EQ(warnings_of_lamp(type, disk + "    edge_value: 0\n"), "x.yaml:6: objects.it: edge_value has" + rest);
        EXPECT_EQ(warnings_of_lamp(type, disk + "    plane_angle: 1\n    edge_value: 0\n"),
                  "x.yaml:7: objects.it: edge_value, plane_angle have" + rest);
        EXPECT_EQ(warnings_of_lamp(type, disk + "    light_mode: static\n    edge_value: 0\n"), "");
    }
}

TEST(UnusedKey, CoordinateOfALampThatStandsAloneWarns) {
    std::string const disk = "    geometry: disk\n    x: 500\n";
    for (std::string const type :
         {"static_light", "orbiting_static_light", "rotating_ray_of_light", "alternating_rays_of_light"}) {
        EXPECT_EQ(warnings_of_lamp(type, disk), "x.yaml:6: objects.it.x: x without y; y is 0. Specify both\n");
        EXPECT_EQ(warnings_of_lamp(type, "    geometry: disk\n    y: 500\n"),
                  "x.yaml:6: objects.it.y: y without x; x is 0. Specify both\n");
        EXPECT_EQ(warnings_of_lamp(type, disk + "    y: 0\n"), "");
        EXPECT_EQ(warnings_of_lamp(type, "    geometry: global\n    x: 500\n"), "") << "from the centre, or unused";
    }
    EXPECT_EQ(warnings_of_lamp("static_light", "    geometry: global\n    light_mode: gradient\n    x: 5\n"),
              "x.yaml:7: objects.it.x: x without y; y is 0. Specify both\n");
}

TEST(UnusedKey, CoordinateOfAnOrbitThatStandsAloneWarns) {
    std::string const orbit = "    geometry: disk\n    center_x: 500\n";
    EXPECT_EQ(warnings_of_lamp("orbiting_static_light", orbit + "    x: 3\n    y: 4\n"),
              "x.yaml:6: objects.it.center_x: center_x without center_y; center_y is 4. Specify both\n");
    EXPECT_EQ(warnings_of_lamp("orbiting_static_light", orbit + "    center_y: 7\n    x: 3\n"), "");
}

TEST(UnusedKey, KeysOfOneFormationWithoutAnInitialFormationWarn) {
    auto const warnings_of = [](std::string const& keys) {
        Warnings const warnings;
        load(kRobots + keys);
        return warnings.text();
    };
    std::string const rest = " no effect with initial_formation power_lloyd, the default; set initial_formation to ";
    std::string const line = "x.yaml:" + std::to_string(1 + std::ranges::count(kRobots, '\n')) + ": ";
    EXPECT_EQ(warnings_of("formation_filename: f.csv\n"), line + "formation_filename has" + rest + "imported\n");
    EXPECT_EQ(warnings_of("formation_filename: f.csv\nformation_time: last\n"),
              line + "formation_filename, formation_time have" + rest + "imported\n");
    EXPECT_EQ(warnings_of("chessboard_distance_between_neighbors: 70\n"),
              line + "chessboard_distance_between_neighbors has" + rest + "chessboard\n");
    EXPECT_EQ(warnings_of("lattice_kind: square\n"), line + "lattice_kind has" + rest + "lattice\n");
    EXPECT_EQ(warnings_of("formation_max_space_between_neighbors: 90\n"),
              line + "formation_max_space_between_neighbors has" + rest + "random\n");
    // A configuration that names its formation may keep the keys of others, and categories may have their own.
    EXPECT_EQ(warnings_of("initial_formation: random\nformation_filename: f.csv\nlattice_kind: square\n"), "");
    Warnings const warnings;
    load("lattice_kind: square\nobjects:\n  robots: {type: pogobot, initial_formation: lattice}\n");
    EXPECT_EQ(warnings.text(), "");
}
