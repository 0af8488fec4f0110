// A wrong configuration ends in one message: where, which key, what was expected, what was found.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "config/map_reader.hpp"
#include "config/reference.hpp"
#include "config/scenario.hpp"
#include "config/source.hpp"
#include "config_file.hpp"
#include "lamps/lamp_types.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

struct BadInput {
    std::string text;     // lines 6 and on
    std::string message;  // behind "x.yaml:6: "
};

void expect_refused(std::string const& head, std::vector<BadInput> const& inputs) {
    for (auto const& [text, message] : inputs) {
        EXPECT_EQ(load_error(head + text + "\n"), "x.yaml:6: " + message) << text;
    }
}

std::string simple_yaml() {
    std::ifstream file(POGOSIM_SOURCE_DIR "/conf/simple.yaml", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The head of a configuration to which the key of a group can be added as the last line.
std::string head_for(KeyGroup const& group) {
    if (group.path.empty()) {
        return kRobots;
    }
    if (group.path == "objects.<category>.msg_success_rate") {
        return kRobots + "    msg_success_rate:\n      type: dynamic\n      ";
    }
    if (group.path == "objects.<category>.battery") {
        return kRobots + "    battery:\n      capacity_mah: 1\n      ";
    }
    if (group.path == "magnetometer") {
        return kRobots + "magnetometer:\n  ";
    }
    if (group.path == "links.<name>") {
        return kRobots + "links:\n  skin:\n    between: robots\n    topology: nearest\n    ";
    }
    std::string const geometry = group.type == "pogowall" ? "arena" : "disk";
    return "objects:\n  robots: {type: pogobot, geometry: disk}\n  thing:\n    type: " + group.type +
           "\n    geometry: " + geometry + "\n    ";
}

/// "a.b: value" as it is written in a file.
std::string assignment(std::string const& dotted_key, std::string const& value) {
    std::size_t const dot = dotted_key.find('.');
    return dot == std::string::npos
               ? dotted_key + ": " + value
               : dotted_key.substr(0, dot) + ": {" + assignment(dotted_key.substr(dot + 1), value) + "}";
}

/// "one of pogobot, ...": what an unknown type is told.
std::string type_names() {
    std::vector<std::string> names;
    for (ObjectType const& type : object_types()) {
        names.emplace_back(type.name);
    }
    return names_text(names);
}

}  // namespace

TEST(BadInput, WrongTypesAndRangesAtTheTopLevel) {
    expect_refused(
        kRobots,
        {{"time_step: 0", "time_step: expected a number above 0, at most 1 (s), found 0"},
         {"time_step: 2", "time_step: expected a number above 0, at most 1 (s), found 2"},
         {"time_step: fast", "time_step: expected a number above 0, at most 1 (s), found 'fast'"},
         {"time_step: .nan", "time_step: expected a number above 0, at most 1 (s), found .nan"},
         {"time_step: [1]", "time_step: expected a number above 0, at most 1 (s), found a list"},
         {"time_step: {a: 1}", "time_step: expected a number above 0, at most 1 (s), found a map"},
         {"simulation_time: -1", "simulation_time: expected a number from 0 to 1000000000 (s), found -1"},
         {"simulation_time: .inf", "simulation_time: expected a number from 0 to 1000000000 (s), found .inf"},
         {"seed: -1", "seed: expected an integer from 0 to 4294967295, found -1"},
         {"seed: 4294967296", "seed: expected an integer from 0 to 4294967295, found 4294967296"},
         {"seed: random", "seed: expected an integer from 0 to 4294967295, found 'random'"},
         {"arena_surface: 0",
          "arena_surface: expected a number above 0, at most 1000000000000 (mm2), or 'file', found 0"},
         {"arena_file: [a]", "arena_file: expected a string, found a list"},
         {"arena_file: ''", "arena_file: expected a file name, found nothing; 'arena_surface' needs it"},
         {"threads: 0", "threads: expected an integer from 1 to 256, or 'auto', found 0"},
         {"threads: 257", "threads: expected an integer from 1 to 256, or 'auto', found 257"},
         {"threads: all", "threads: expected an integer from 1 to 256, or 'auto', found 'all'"},
         {"threads: [2]", "threads: expected an integer from 1 to 256, or 'auto', found a list"},
         {"GUI: 2", "GUI: expected true or false, found 2"},
         {"GUI: maybe", "GUI: expected true or false, found 'maybe'"},
         {"window_width: 0", "window_width: expected an integer from 1 to 16384 (pixels), found 0"},
         {"light_map_nb_bin_x: 10001", "light_map_nb_bin_x: expected an integer from 1 to 10000 (cells), found 10001"},
         {"boundary_condition: soft", "boundary_condition: expected solid or periodic, found 'soft'"},
         {"boundary_condition: Solid",
          "boundary_condition: expected solid or periodic, found 'Solid'; did you mean "
          "'solid'?"},
         {"boundary_condition: [solid]", "boundary_condition: expected solid or periodic, found a list"},
         {"log_format: xml", "log_format: expected one of default, date, minimal, found 'xml'"},
         {"data_logger_fields: time", "data_logger_fields: expected a list of names, found 'time'"},
         {"data_logger_fields: [time, [x]]", "data_logger_fields.1: expected a string, found a list"},
         {"data_logger_flush_row_count: 0",
          "data_logger_flush_row_count: expected an integer from 1 to 1000000000 (rows), found 0"},
         {"initial_formation_center: 5",
          "initial_formation_center: expected a list [x, y] of two numbers from -1000000 to 1000000 or .nan (mm), "
          "found 5"},
         {"initial_formation_center: [5]",
          "initial_formation_center: expected a list [x, y] of two numbers from -1000000 to 1000000 or .nan (mm), "
          "found a list of 1"},
         {"initial_formation_root_object: nobody",
          "initial_formation_root_object: expected 'arena' or a category of 'objects', found 'nobody'"},
         {"initial_formation: imported",
          "formation_filename: expected a file name, found nothing; 'initial_formation' needs it"},
         {"data_filename: ''", "data_filename: expected a file name, found nothing; 'enable_data_logging' needs it"},
         {"data_filename:", "data_filename: expected a file name, found nothing; 'enable_data_logging' needs it"},
         {"parameters: [1]", "parameters: expected a map of keys, found a list"}});
}

TEST(BadInput, OptionsOfParametersNeedADefaultWhenValuesAreStrict) {
    std::string const open =
        kRobots + "parameters: {a: {b: {batch_options: [1]}}, c: {batch_options: [1], default_option: 2}}\n";
    EXPECT_EQ(load_error(open), "no error");  // the program may not read it
    EXPECT_EQ(load_error(open, {.strict_values = true}),
              "x.yaml:6: parameters.a.b: has batch_options but no default_option; run it with pogobatch");
}

TEST(BadInput, ObjectsAreAMap) {
    EXPECT_EQ(load_error("objects: 5\n"), "x.yaml:1: objects: expected a map of categories, found 5");
    EXPECT_EQ(load_error("objects: [robots]\n"), "x.yaml:1: objects: expected a map of categories, found a list");
}

TEST(BadInput, SetNeedsAValue) {
    for (std::string const value : {"", " ", " # nothing"}) {
        EXPECT_EQ(load_error(kRobots, {.overrides = {"objects.robots.nb=" + value}}),
                  "--set 'objects.robots.nb=" + value +
                      "': nothing stands behind '='; for the default, write objects.robots.nb=null");
    }
    for (std::string const value : {"null", "~", "''"}) {
        EXPECT_EQ(load_error(kRobots, {.overrides = {"console_filename=" + value}}), "no error");
    }
}

TEST(BadInput, UnknownFormationNamesTheNearest) {
    std::string const message = load_error(kRobots + "initial_formation: lloid\n");
    EXPECT_NE(message.find("x.yaml:6: initial_formation: expected one of "), std::string::npos) << message;
    EXPECT_NE(message.find("found 'lloid'; did you mean 'lloyd'?"), std::string::npos) << message;
}

TEST(BadInput, FileNamesCountOnlyWhenTheFileIsWritten) {
    EXPECT_EQ(load_error(kRobots + "data_filename: ''\nenable_data_logging: false\n"), "no error");
    EXPECT_EQ(load_error(kRobots + "console_filename: ''\n"), "no error");
    EXPECT_EQ(load_error(kRobots + "console_filename: ''\nenable_console_logging: true\n"),
              "x.yaml:6: console_filename: expected a file name, found nothing; 'enable_console_logging' needs it");
}

TEST(BadInput, FileNameThatIsMissingIsToldOnce) {
    std::string const settings = kRobots + "enable_console_logging: true\ninitial_formation: imported\n";
    for (std::string const key : {"arena_file", "data_filename", "console_filename", "formation_filename"}) {
        Warnings const warnings;
        std::string const message = load_error(settings + key + ":\n");
        EXPECT_NE(message.find(key + ": expected a file name, found nothing; '"), std::string::npos) << message;
        EXPECT_EQ(warnings.text(), "") << key;
        std::string const options = load_error(settings + key + ": {batch_options: [a, b]}\n");
        EXPECT_NE(options.find(key + ": has batch_options but no default_option; run it with pogobatch"),
                  std::string::npos)
            << options;
    }
}

TEST(BadInput, FrameNamesHoldOneNumber) {
    for (char const* name : {"f.png", "f{}{}.png", "f{:s}.png", "f{0}.png", "f{", "f}", "f{:{}}.png", "f{:d}.png",
                             "f{:0999999999f}.png", "f{{}}.png", ""}) {
        EXPECT_EQ(load_error(kRobots + "frames_name: '" + name + "'\nsave_video_period: 1\n"),
                  std::string("x.yaml:6: frames_name: expected a name with one field for the time, like "
                              "'frames/f{:010.4f}.png', found '") +
                      name + "'");
        EXPECT_EQ(load_error(kRobots + "frames_name: '" + name + "'\n"), "no error");
    }
    for (char const* name : {"f{}.png", "f{:010.4f}.png", "{:.2f}", "{:g}", "{:+8.3e}", "{:>12}"}) {
        EXPECT_EQ(load_error(kRobots + "frames_name: '" + name + "'\nsave_video_period: 1\n"), "no error") << name;
    }
}

TEST(BadInput, MoreStepsThanCanBeCountedAreRefused) {
    EXPECT_EQ(load_error(kRobots + "time_step: 1e-30\n"),
              "x.yaml:6: time_step: 1e-30 s is too short for a run of 100 s; use at least 1.1102230246251565e-14 s");
    EXPECT_EQ(load_error(kRobots + "save_data_period: 1e-300\n").substr(0, 27), "x.yaml:6: save_data_period:");
    EXPECT_EQ(load_error(kRobots + "save_video_period: 1e-300\n").substr(0, 28), "x.yaml:6: save_video_period:");
}

TEST(BadInput, WrongRobots) {
    expect_refused(
        kRobots,
        {{"    nb: many", "objects.robots.nb: expected an integer from 0 to 10000000, found 'many'"},
         {"    nb: -1", "objects.robots.nb: expected an integer from 0 to 10000000, found -1"},
         {"    nb: {batch_options: [1], default_option: arenas/disk.csv}",
          "objects.robots.nb: expected an integer from 0 to 10000000, found 'arenas/disk.csv'"},
         {"    body_density: -1",
          "objects.robots.body_density: expected a number from 0 to 1000000000000000 (kg per (100 mm)^2), found -1"},
         {"    body_restitution: 1.8", "objects.robots.body_restitution: expected a number from 0 to 1, found 1.8"},
         {"    communication_radius: -3",
          "objects.robots.communication_radius: expected a number from 0 to 1000000 (mm), found -3"},
         {"    message_queue_size: 0",
          "objects.robots.message_queue_size: expected an integer from 1 to 1000 (messages), found 0"},
         {"    angular_systematic_bias_domain: [3, -3]",
          "objects.robots.angular_systematic_bias_domain: expected [smallest, largest], found [3, -3]"},
         {"    angular_systematic_bias_domain: [0, 5000]",
          "objects.robots.angular_systematic_bias_domain.1: expected an integer from -1023 to 1023 (motor power "
          "units), found 5000"},
         {"    x: 5", "objects.robots.x: x without y; specify both or neither"},
         {"    y: 5", "objects.robots.y: y without x; specify both or neither"},
         {"    x: left", "objects.robots.x: expected a number from -1000000 to 1000000 (mm), found 'left'"},
         {"    msg_success_rate: 0.9",
          "objects.robots.msg_success_rate: expected a map of keys, such as {type: static, rate: 0.9}, found 0.9"},
         {"    msg_success_rate: {rate: 1}",
          "objects.robots.msg_success_rate: the key 'type' is missing; expected one of static, dynamic, realistic"},
         {"    msg_success_rate: {type: magic}",
          "objects.robots.msg_success_rate.type: expected one of static, dynamic, realistic, found 'magic'"},
         {"    msg_success_rate: {type: static, rate: 2}",
          "objects.robots.msg_success_rate.rate: expected a number from 0 to 1, found 2"},
         {"    msg_success_rate: {type: dynamic, alpha: .nan}",
          "objects.robots.msg_success_rate.alpha: expected a number, found .nan"}});
}

TEST(BadInput, WrongLights) {
    expect_refused(kLamp, {{"    value: 32768",
                            "objects.lamp.value: expected an integer from 0 to 32767 (sensor counts), found "
                            "32768"},
                           {"    value: bright",
                            "objects.lamp.value: expected an integer from 0 to 32767 (sensor counts), found "
                            "'bright'"},
                           {"    light_mode: [static]",
                            "objects.lamp.light_mode: expected one of static, gradient, plane, found "
                            "a list"},
                           {"    photo_start_duration: long",
                            "objects.lamp.photo_start_duration: expected a number from 0 to "
                            "1000000000 (s), found 'long'"},
                           {"    plane_half_span: wide",
                            "objects.lamp.plane_half_span: expected a number above 0, at most 1000000 "
                            "(mm), found 'wide'"}});
}

std::string lamp_of(std::string const& type) {
    return "objects:\n  robots: {type: pogobot, geometry: disk}\n  lamp:\n    geometry: global\n    type: " + type +
           "\n";
}

TEST(BadInput, WrongMovingLights) {
    for (std::string const type : {"rotating_ray_of_light", "alternating_rays_of_light"}) {
        expect_refused(
            lamp_of(type),
            {{"    value: -1", "objects.lamp.value: expected an integer from 0 to 32767 (sensor counts), found -1"},
             {"    white_frame_value: 32768",
              "objects.lamp.white_frame_value: expected an integer from 0 to 32767 (sensor counts), found 32768"},
             {"    ray_half_width: 0",
              "objects.lamp.ray_half_width: expected a number above 0, at most 3.141592653589793 (rad), found 0"},
             {"    ray_half_width: 3.2",
              "objects.lamp.ray_half_width: expected a number above 0, at most 3.141592653589793 (rad), found 3.2"},
             {"    angular_speed: .inf",
              "objects.lamp.angular_speed: expected a number from -10000 to 10000 (rad/s), found .inf"}});
        EXPECT_EQ(load_error(lamp_of(type) + "    angular_speed: -3\n    ray_half_width: 3.14\n"), "no error");
    }
    expect_refused(lamp_of("rotating_ray_of_light"),
                   {{"    white_frame_duration: -1",
                     "objects.lamp.white_frame_duration: expected a number from 0 to 1000000000 (s), found -1"},
                    {"    photo_start_duration: long",
                     "objects.lamp.photo_start_duration: expected a number from 0 to 1000000000 (s), found 'long'"}});
    expect_refused(lamp_of("alternating_rays_of_light"),
                   {{"    long_white_frame_duration: -1",
                     "objects.lamp.long_white_frame_duration: expected a number from 0 to 1000000000 (s), found -1"},
                    {"    short_white_frame_duration: -1",
                     "objects.lamp.short_white_frame_duration: expected a number from 0 to 1000000000 (s), found -1"}});
    expect_refused(
        lamp_of("orbiting_static_light"),
        {{"    orbit_radius: -1", "objects.lamp.orbit_radius: expected a number from 0 to 1000000 (mm), found -1"},
         {"    center_x: left",
          "objects.lamp.center_x: expected a number from -1000000 to 1000000 (mm), found 'left'"}});
    EXPECT_EQ(load_error(lamp_of("orbiting_static_light") + "    orbit_angular_speed: 1\n    angular_speed: 2\n"),
              "x.yaml:7: objects.lamp.angular_speed: is an alias of orbit_angular_speed; use one or the other");
}

TEST(BadInput, ObjectsNeedTypeAndGeometry) {
    EXPECT_EQ(load_error("objects:\n  a:\n    nb: 1\n"),
              "x.yaml:2: objects.a: the key 'type' is missing; expected " + type_names());
    EXPECT_EQ(load_error("objects:\n  a:\n"),
              "x.yaml:2: objects.a: the key 'type' is missing; expected " + type_names());
    EXPECT_EQ(load_error("objects:\n  a: {type: pogobject}\n"),
              "x.yaml:2: objects.a: the key 'geometry' is missing; expected one of disk, rectangle, capsule, "
              "triangle, polygon, compound");
    EXPECT_EQ(load_error("objects:\n  a: {type: static_light}\n"),
              "x.yaml:2: objects.a: the key 'geometry' is missing; expected one of global, arena, disk, rectangle, "
              "capsule, triangle, polygon");
    EXPECT_EQ(load_error("objects:\n  a: {type: pogobject, geometry: ~}\n"),
              "x.yaml:2: objects.a: the key 'geometry' is missing; expected one of disk, rectangle, capsule, "
              "triangle, polygon, compound");
    EXPECT_EQ(load_error("objects:\n  a: {type: pogobot, geometry: global}\n"),
              "x.yaml:2: objects.a.geometry: expected one of disk, rectangle, capsule, triangle, polygon, "
              "compound, found 'global'");
    EXPECT_EQ(load_error("objects:\n  a: {type: [pogobot]}\n"),
              "x.yaml:2: objects.a.type: expected " + type_names() + ", found a list");
    EXPECT_EQ(load_error("objects:\n  a: {type: pogobt}\n"),
              "x.yaml:2: objects.a.type: expected " + type_names() + ", found 'pogobt'; did you mean 'pogobot'?");
    EXPECT_EQ(load_error("objects:\n  a: 5\n"), "x.yaml:2: objects.a: expected a map of keys, found 5");
}

TEST(BadInput, MoreThanTenMillionObjectsAreRefused) {
    std::string const most = "objects:\n  a: {type: pogobot, geometry: disk, nb: 9999999}\n";
    EXPECT_EQ(load_error(most + "  b: {type: pogobot, geometry: disk, nb: 2}\n"),
              "x.yaml:1: objects: expected at most 10000000 objects in all categories, found 10000001");
    EXPECT_EQ(load_error(most + "  b: {type: pogobot, geometry: disk}\n"), "no error");
}

TEST(BadInput, MoreDotsThanIndicesAreRefused) {
    std::string const membranes = "objects:\n  a: {type: membrane, geometry: disk, radius: 50, num_dots: 10000, nb: ";
    EXPECT_EQ(load_error(membranes + "214749}\n"),
              "x.yaml:1: objects: expected at most 2147483647 dots of membranes and other objects, found 2147490000");
    EXPECT_EQ(load_error(membranes + "214748}\n"), "no error");
}

TEST(BadInput, UnknownPhysicsEngineIsRefusedWithTheNearestName) {
    EXPECT_EQ(load_error("physics_engine: box3d\n"),
              "x.yaml:1: physics_engine: expected one of auto, disk, box2d, found 'box3d'; did you mean 'box2d'?");
    EXPECT_EQ(load_error("physics_engine: [box2d]\n"),
              "x.yaml:1: physics_engine: expected one of auto, disk, box2d, found a list");
    EXPECT_EQ(load_error("physics_engine: box2d\n"), "no error");
    EXPECT_EQ(load_error("physics_engine: auto\n"), "no error");
}

TEST(BadInput, TheWholeFileCannotBeAnOption) {
    Warnings const warnings;
    EXPECT_EQ(load_error("default_option: 5\n"), "x.yaml:1: the top level: expected a map of keys, found 5");
    EXPECT_EQ(load_error("batch_options: [5]\n"),
              "x.yaml:1: the top level: has batch_options but no default_option; run it with pogobatch");
}

TEST(BadInput, SetIsCheckedLikeTheFile) {
    EXPECT_EQ(load_error(kRobots, {.overrides = {"objects.robots.nb=many"}}),
              "--set: objects.robots.nb: expected an integer from 0 to 10000000, found 'many'");
    EXPECT_EQ(load_error(kRobots, {.overrides = {"nonsense"}}), "--set 'nonsense': expected key.path=value");
}

TEST(BadInput, EveryKeyOfEveryTableRefusesAMapAndNonsense) {
    Warnings const warnings;  // of keys that now stand twice
    int checked = 0;
    for (KeyGroup const& group : configuration_reference(object_types())) {
        for (KeyDescription const& key : group.keys) {
            bool const is_text = key.expected == "a string";
            bool const is_free = key.name == "parameters" || key.name == "optimization" || key.name == "progress_bar" ||
                                 key.name.starts_with("result_") || key.name == "light_mode" || key.required ||
                                 key.name == "pogobatch" || key.name == "_rundr";
            bool const is_map = key.expected.starts_with("a map");
            if (is_free) {
                continue;
            }
            auto const error_with = [&](std::string const& value) {
                return load_error(head_for(group) + assignment(key.name, value) + "\n");
            };
            bool const takes_maps =
                is_map && (key.name == "objects" || key.name == "magnetometer" || key.name == "flash_state" ||
                           key.name == "view" || key.name == "processor" || key.expected == kMapOfKeysBelow);
            if (!takes_maps) {
                EXPECT_NE(error_with("{zzz: {}}"), "no error") << group.path << ' ' << key.name;
            }
            if (!is_text) {
                EXPECT_NE(error_with("zzz"), "no error") << group.path << ' ' << key.name;
            }
            ++checked;
        }
    }
    EXPECT_GT(checked, 80);
}

TEST(BadInput, MutilatedConfigurationsLoadOrAreRefusedAndNothingElse) {
    Folder const folder;
    Warnings const warnings;
    std::string const original = simple_yaml();
    ASSERT_GT(original.size(), 1000U);
    std::string const spice = "{}[]:,-#&*!|>'\"%@`?\n\t \\~<=0x.e9\xFF\xC3\x01";
    RandomStream random(2026, 7);
    auto const place = [&](std::string const& text) { return random.below(static_cast<std::uint32_t>(text.size())); };
    int loaded = 0;
    int refused = 0;
    for (int i = 0; i < 2500; ++i) {
        std::string text = original;
        for (std::uint32_t edits = 1 + random.below(4); edits > 0 && !text.empty(); --edits) {
            std::size_t const at = place(text);
            std::size_t const length = 1 + random.below(random.below(4) == 0 ? 400 : 12);
            switch (random.below(6)) {
                case 0:
                    text[at] = static_cast<char>(random.bits());
                    break;
                case 1:
                    text[at] = spice[place(spice)];
                    break;
                case 2:
                    text.insert(at, 1, spice[place(spice)]);
                    break;
                case 3:
                    text.erase(at, length);
                    break;
                case 4:
                    text.insert(place(text), text.substr(at, length));
                    break;
                default:
                    text.resize(at);
                    break;
            }
        }
        Folder::write("fuzz.yaml", text);
        try {
            Scenario const scenario = load_scenario("fuzz.yaml", {}, object_types());
            EXPECT_EQ(to_yaml(scenario.source->tree).empty(), false);
            ++loaded;
        } catch (ConfigError const& error) {
            EXPECT_NE(std::string(error.what()).find("fuzz.yaml"), std::string::npos) << error.what();
            ++refused;
        }
    }
    EXPECT_GT(loaded, 400);
    EXPECT_GT(refused, 400);
}
