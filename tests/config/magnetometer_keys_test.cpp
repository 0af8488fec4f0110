// The map `magnetometer`: every key, in its unit, and every kind of mistake.
#include "config/scenario_keys.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "config/source.hpp"
#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
std::string const kCsv = "  source: csv\n";

MagnetometerConfig magnetometer(std::string const& lines) {
    return load(kRobots + "magnetometer:\n" + lines).magnetometer;
}

/// The message behind the line number of a wrong map, which begins on line 7.
std::string error_in(std::string const& lines) {
    return load_error(kRobots + "magnetometer:\n" + lines);
}

std::string warnings_of(std::string const& lines) {
    Warnings const warnings;
    magnetometer(lines);
    return warnings.text();
}

void expect_interval(Interval const& found, double min, double max) {
    EXPECT_DOUBLE_EQ(found.min, min);
    EXPECT_DOUBLE_EQ(found.max, max);
}

TEST(MagnetometerKeys, WithoutTheMapRobotsHaveTheDefaultModel) {
    MagnetometerConfig const config = load(kRobots).magnetometer;
    EXPECT_EQ(config.source, MagnetometerSource::procedural);
    EXPECT_FALSE(config.seed);
    MagnetometerSpec const& spec = config.spec;
    EXPECT_EQ(spec.timing, MagnetometerTiming::at_once);
    EXPECT_EQ(spec.field.at_origin, (Axes{1.0, 0.0, 0.0}));
    expect_interval(spec.ellipse.centre.x, 425.0, 425.0);
    expect_interval(spec.ellipse.major_radius, 160.0, 160.0);
    expect_interval(spec.variation.noise_stddev.z, 3.0, 3.0);
    ASSERT_EQ(spec.harmonics.size(), 1U);
    EXPECT_EQ(spec.harmonics[0].order, 2);
    expect_interval(spec.harmonics[0].cosine.x, 12.0, 12.0);
    expect_interval(spec.harmonics[0].sine.y, 4.0, 4.0);
    EXPECT_EQ(warnings_of("  world_field: {}\n"), "");
    EXPECT_EQ(load(kRobots).source->values.find("magnetometer"), nullptr);  // nothing is added to data files
}

TEST(MagnetometerKeys, AllIntervalsAreRead) {
    MagnetometerSpec const spec =
        magnetometer(
            "  timing: robot\n"
            "  scale_signal_with_field_magnitude: false\n"
            "  robot_variation:\n"
            "    additional_bias: {x: [-15, 15], y: [2], z: [0, 0]}\n"
            "    signal_gain: [0.95, 1.05]\n"
            "    noise_stddev: {x: [2, 5]}\n"
            "  output: {quantization_step: 2, clamp: true, limits: {y: [-10, 10]}}\n"
            "  procedural:\n"
            "    ellipse: {center: {z: [1, 2]}, major_radius: [150], minor_radius: [100, 120],\n"
            "              z_cos_amplitude: [7], z_sin_amplitude: [-8]}\n"
            "    distortion_harmonics:\n"
            "      - {order: 3, cos: {x: [1, 2]}, sin: {z: [5]}}\n"
            "      - {}\n")
            .spec;
    EXPECT_EQ(spec.timing, MagnetometerTiming::robot);
    EXPECT_FALSE(spec.scales_with_field);
    expect_interval(spec.variation.additional_bias.x, -15.0, 15.0);
    expect_interval(spec.variation.additional_bias.y, 2.0, 2.0);
    expect_interval(spec.variation.signal_gain, 0.95, 1.05);
    expect_interval(spec.variation.noise_stddev.x, 2.0, 5.0);
    expect_interval(spec.variation.noise_stddev.y, 3.0, 3.0);
    EXPECT_EQ(spec.output.quantization_step, 2.0);
    EXPECT_TRUE(spec.output.clamp);
    expect_interval(spec.output.limits.x, 250.0, 600.0);
    expect_interval(spec.output.limits.y, -10.0, 10.0);
    expect_interval(spec.ellipse.centre.z, 1.0, 2.0);
    expect_interval(spec.ellipse.minor_radius, 100.0, 120.0);
    expect_interval(spec.ellipse.z_sine, -8.0, -8.0);
    ASSERT_EQ(spec.harmonics.size(), 2U);
    EXPECT_EQ(spec.harmonics[0].order, 3);
    expect_interval(spec.harmonics[0].cosine.x, 1.0, 2.0);
    expect_interval(spec.harmonics[0].sine.z, 5.0, 5.0);
    EXPECT_EQ(spec.harmonics[1].order, 2);
    expect_interval(spec.harmonics[1].cosine.x, 0.0, 0.0);
    EXPECT_TRUE(magnetometer("  procedural: {distortion_harmonics: []}\n").spec.harmonics.empty());
}

TEST(MagnetometerKeys, AnglesAreInTheUnitOfTheMap) {
    std::string const angles =
        "  world_field: {magnetic_north_angle: 2, horizontal_magnitude: 3, vertical_component: 4}\n"
        "  domain: {theta: [0, 3]}\n"
        "  robot_variation: {angle_offset: [-2, 2]}\n"
        "  procedural: {ellipse: {ellipse_rotation: [1], sensor_phase_offset: [5]}}\n"
        "  csv: {calibration_field_angle: 3}\n";
    for (auto const& [unit, factor] : {std::pair{"degrees", kDegree},
                                       {"deg", kDegree},
                                       {"degree", kDegree},
                                       {"radians", 1.0},
                                       {"rad", 1.0},
                                       {"radian", 1.0}}) {
        MagnetometerConfig const config = magnetometer(std::string("  angle_unit: ") + unit + "\n" + angles);
        MagnetometerSpec const& spec = config.spec;
        EXPECT_NEAR(spec.field.at_origin[0], 3.0 * std::cos(2.0 * factor), 1e-9);
        EXPECT_NEAR(spec.field.at_origin[1], 3.0 * std::sin(2.0 * factor), 1e-9);
        EXPECT_EQ(spec.field.at_origin[2], 4.0);
        expect_interval(*spec.domain.heading_rad, 0.0, 3.0 * factor);
        expect_interval(spec.variation.angle_offset_rad, -2.0 * factor, 2.0 * factor);
        expect_interval(spec.ellipse.rotation_rad, factor, factor);
        expect_interval(spec.ellipse.phase_offset_rad, 5.0 * factor, 5.0 * factor);
        EXPECT_DOUBLE_EQ(*config.table.field_angle_rad, 3.0 * factor);
    }
}

TEST(MagnetometerKeys, FieldHasThreeForms) {
    EXPECT_EQ(magnetometer("  world_field: {vector: [3, 4, 5]}\n").spec.field.at_origin, (Axes{3.0, 4.0, 5.0}));
    EXPECT_EQ(magnetometer("  world_field: {x: 3, z: 5}\n").spec.field.at_origin, (Axes{3.0, 0.0, 5.0}));
    EXPECT_EQ(magnetometer("  world_field: {horizontal_magnitude: 2}\n").spec.field.at_origin, (Axes{2.0, 0.0, 0.0}));
    MagneticField const field = magnetometer(
                                    "  world_field: {gradient_x: [0.1, 0, 0], gradient_y: [0, 0.2, 0.3], "
                                    "origin: [500, 400]}\n")
                                    .spec.field;
    EXPECT_EQ(field.gradient_x, (Axes{0.1, 0.0, 0.0}));
    EXPECT_EQ(field.gradient_y, (Axes{0.0, 0.2, 0.3}));
    EXPECT_EQ(field.origin_mm, (Vec2{500.0F, 400.0F}));
}

TEST(MagnetometerKeys, TwoFormsOfTheFieldAreToldAndTheFirstIsUsed) {
    EXPECT_NE(warnings_of("  world_field: {vector: [3, 4, 5], x: 1}\n").find("given in several ways; 'vector' is used"),
              std::string::npos);
    std::string const two = "  world_field: {x: 0, y: 2, magnetic_north_angle: 30}\n";
    EXPECT_NE(warnings_of(two).find("'x', 'y' and 'z' are used, and magnetic_north_angle"), std::string::npos);
    Warnings const warnings;
    EXPECT_EQ(magnetometer(two).spec.field.at_origin, (Axes{0.0, 2.0, 0.0}));
}

TEST(MagnetometerKeys, FieldWithoutHorizontalPartIsTold) {
    EXPECT_NE(warnings_of("  world_field: {vector: [0, 0, 1]}\n").find("readings do not depend on the heading"),
              std::string::npos);
}

TEST(MagnetometerKeys, DomainAndItsPolicies) {
    MagneticDomain const domain =
        magnetometer("  domain: {x: [0, 1000], y: [-5, 5], wrap_theta: false, policy: throw_error}\n").spec.domain;
    expect_interval(*domain.x_mm, 0.0, 1000.0);
    expect_interval(*domain.y_mm, -5.0, 5.0);
    EXPECT_FALSE(domain.heading_rad);
    EXPECT_FALSE(domain.wrap_heading);
    EXPECT_EQ(domain.policy, DomainPolicy::refuse);
    EXPECT_EQ(magnetometer("  domain: {policy: throw}\n").spec.domain.policy, DomainPolicy::refuse);
    EXPECT_EQ(magnetometer("  domain: {policy: clamp}\n").spec.domain.policy, DomainPolicy::clamp);
    EXPECT_EQ(magnetometer("  domain: {policy: allow}\n").spec.domain.policy, DomainPolicy::allow);
}

TEST(MagnetometerKeys, TableHasItsSettings) {
    MagnetometerConfig const config = magnetometer(
        "  source: csv_fit\n"
        "  csv:\n"
        "    file: table.csv\n"
        "    delimiter: \";\"\n"
        "    comment_prefix: \"//\"\n"
        "    columns: {angle: heading, z: up}\n"
        "    input_angle_unit: radians\n"
        "    harmonic_order: 5\n"
        "    ridge_regularization: 0.5\n"
        "    skip_invalid_rows: false\n"
        "    add_fit_residual_as_noise: false\n");
    EXPECT_EQ(config.source, MagnetometerSource::csv);
    MagnetometerTable const& table = config.table;
    EXPECT_EQ(table.file, "table.csv");
    EXPECT_EQ(table.delimiter, ";");
    EXPECT_EQ(table.comment_prefix, "//");
    EXPECT_EQ(table.columns.angle, "heading");
    EXPECT_EQ(table.columns.x, "mag_x");
    EXPECT_EQ(table.columns.z, "up");
    EXPECT_EQ(table.angle_unit, AngleUnit::radians);
    EXPECT_EQ(table.harmonic_order, 5);
    EXPECT_EQ(table.ridge, 0.5);
    EXPECT_FALSE(table.skip_invalid_rows);
    EXPECT_FALSE(table.residual_is_noise);
    EXPECT_FALSE(table.field_angle_rad);
    MagnetometerTable const plain =
        magnetometer(kCsv + "  csv: {file: a.csv, has_header: false, column_indices: {x: 5}}\n").table;
    EXPECT_FALSE(plain.has_header);
    EXPECT_EQ(plain.column_indices.angle, 0);
    EXPECT_EQ(plain.column_indices.x, 5);
}

TEST(MagnetometerKeys, SeedHas64Bits) {
    EXPECT_EQ(magnetometer("  random_seed: 18446744073709551615\n").seed, 18446744073709551615ULL);
    EXPECT_EQ(magnetometer("  random_seed: 1e3\n").seed, 1000U);
    EXPECT_EQ(magnetometer("  random_seed: null\n").seed, std::nullopt);
    EXPECT_EQ(error_in("  random_seed: -1\n"),
              "x.yaml:7: magnetometer.random_seed: expected an integer of at least 0, found -1");
    EXPECT_EQ(error_in("  random_seed: 18446744073709551616\n"),
              "x.yaml:7: magnetometer.random_seed: expected an integer of at least 0, found 18446744073709551616");
}

TEST(MagnetometerKeys, MistakesAreNamedWithTheirLine) {
    struct Mistake {
        std::string lines;
        std::string message;
    };
    for (auto const& [lines, message] : std::vector<Mistake>{
             {"  source: table\n", "source: expected one of procedural, csv, csv_fit, found 'table'"},
             {"  angle_unit: turns\n",
              "angle_unit: expected one of degrees, degree, deg, radians, radian, rad, found 'turns'"},
             {"  timing: slow\n", "timing: expected at_once or robot, found 'slow'"},
             {"  world_field: 3\n", "world_field: expected a map of keys, found 3"},
             {"  world_field: {vector: [1, 2]}\n",
              "world_field.vector: expected a list [x, y, z] of numbers from -1000000 to 1000000, found a list of 2"},
             {"  world_field: {horizontal_magnitude: -1}\n",
              "world_field.horizontal_magnitude: expected a number from 0 to 1000000, found -1"},
             {"  domain: {x: [5]}\n", "domain.x: expected [smallest, largest], found [5]"},
             {"  domain: {theta: [5, 5]}\n", "domain.theta: expected [smallest, largest], found [5]"},
             {"  domain: {y: [7, 5]}\n", "domain.y: expected [smallest, largest], found [7, 5]"},
             {"  domain: {policy: ignore}\n",
              "domain.policy: expected one of allow, clamp, throw, throw_error, found 'ignore'"},
             {"  robot_variation: {signal_gain: 1.5}\n",
              "robot_variation.signal_gain: expected a list [value] or [smallest, largest] of numbers from -1000000 to "
              "1000000, found 1.5"},
             {"  robot_variation: {signal_gain: [1, 2, 3]}\n",
              "robot_variation.signal_gain: expected a list [value] or [smallest, largest] of numbers from -1000000 to "
              "1000000, found a list of 3"},
             {"  robot_variation: {signal_gain: []}\n",
              "robot_variation.signal_gain: expected a list [value] or [smallest, largest] of numbers from -1000000 to "
              "1000000, found a list of 0"},
             {"  robot_variation: {noise_stddev: {x: [-1, 2]}}\n",
              "robot_variation.noise_stddev.x.0: expected a number from 0 to 1000000 (counts), found -1"},
             {"  robot_variation: {noise_stddev: [3]}\n",
              "robot_variation.noise_stddev: expected a map of keys, found a list"},
             {"  procedural: {ellipse: {major_radius: [-5]}}\n",
              "procedural.ellipse.major_radius.0: expected a number from 0 to 1000000 (counts), found -5"},
             {"  procedural: {distortion_harmonics: {order: 2}}\n",
              "procedural.distortion_harmonics: expected a list of maps {order, cos: {x, y, z}, sin: {x, y, z}}, found "
              "a map"},
             {"  procedural: {distortion_harmonics: [{order: 1}]}\n",
              "procedural.distortion_harmonics.0.order: expected an integer from 2 to 32, found 1"},
             {"  procedural: {distortion_harmonics: [{order: 2}, 7]}\n",
              "procedural.distortion_harmonics.1: expected a map of keys, found 7"},
         }) {
        EXPECT_EQ(error_in(lines), "x.yaml:7: magnetometer." + message) << lines;
    }
    EXPECT_EQ(
        load_error(kRobots + "magnetometer: [1]\n"),
        "x.yaml:6: magnetometer: expected a map of keys, such as {source: csv, csv: {file: table.csv}}, found a list");
}

TEST(MagnetometerKeys, MistakesOfTheTableAreNamed) {
    for (std::string const lines : {"", "  csv: {harmonic_order: 2}\n", "  csv: {file: \"\"}\n", "  csv:\n"}) {
        EXPECT_EQ(error_in(kCsv + lines),
                  "x.yaml:7: magnetometer.source: csv needs csv.file, a table of headings and readings");
    }
    EXPECT_EQ(error_in(kCsv + "  csv: {file: a.csv, harmonic_order: 0}\n"),
              "x.yaml:8: magnetometer.csv.harmonic_order: expected an integer from 1 to 32, found 0");
    EXPECT_EQ(error_in(kCsv + "  csv: {file: a.csv, ridge_regularization: -1}\n"),
              "x.yaml:8: magnetometer.csv.ridge_regularization: expected a number from 0 to 1000000000000, found -1");
    for (std::string const delimiter : {"\", \"", "\"\"", "\"1\"", "tab", "\"\\\"\""}) {
        EXPECT_NE(
            error_in(kCsv + "  csv: {file: a.csv, delimiter: " + delimiter + "}\n")
                .find("x.yaml:8: magnetometer.csv.delimiter: expected one character that is not part of a number"),
            std::string::npos)
            << delimiter;
    }
    EXPECT_EQ(error_in(kCsv + "  csv: {file: a.csv, has_header: false, column_indices: {x: -1}}\n"),
              "x.yaml:8: magnetometer.csv.column_indices.x: expected an integer from 0 to 1000, found -1");
}

TEST(MagnetometerKeys, KeysOfTheOtherSourceOnlyNeedTheRightType) {
    EXPECT_EQ(error_in("  csv: {harmonic_order: 0, delimiter: tab}\n"), "no error");
    EXPECT_NE(error_in("  csv: {harmonic_order: many}\n"), "no error");
    EXPECT_EQ(error_in(kCsv + "  csv: {file: a.csv}\n  procedural: {ellipse: {major_radius: [-5]}}\n"), "no error");
}

TEST(MagnetometerKeys, UnknownKeysAreToldWithTheNearestName) {
    EXPECT_EQ(warnings_of("  world_field: {vectr: [1, 0, 0]}\n"),
              "x.yaml:7: unknown key 'magnetometer.world_field.vectr' is ignored; did you mean 'vector'?\n");
    EXPECT_EQ(warnings_of("  procedural: {distortion_harmonics: [{ordr: 3}]}\n"),
              "x.yaml:7: unknown key 'magnetometer.procedural.distortion_harmonics.0.ordr' is ignored; did you mean "
              "'order'?\n");
    EXPECT_EQ(load_error(kRobots + "magnetometer:\n  souce: csv\n", {.overrides = {}, .strict = true}),
              "x.yaml:7: unknown key 'magnetometer.souce'; did you mean 'source'? (--strict)");
}

TEST(MagnetometerKeys, ValuesInUseAreReadBackAsTheyAre) {
    std::string const lines =
        "  angle_unit: rad\n  world_field: {magnetic_north_angle: 0.3}\n"
        "  robot_variation: {angle_offset: [-0.1, 0.2], additional_bias: {x: [-15, 15]}}\n"
        "  procedural: {distortion_harmonics: [{order: 3, sin: {y: [1, 2]}}]}\n";
    Scenario const first = load(kRobots + "magnetometer:\n" + lines);
    Node root;
    root.kind = Node::Kind::map;
    root.entries.emplace_back("objects", *first.source->values.find("objects"));
    root.entries.emplace_back("magnetometer", *first.source->values.find("magnetometer"));
    Scenario const second = load(to_yaml(root));
    EXPECT_EQ(to_yaml(*second.source->values.find("magnetometer")), to_yaml(root.entries.back().value));
    EXPECT_EQ(second.magnetometer.spec.field.at_origin, first.magnetometer.spec.field.at_origin);
    expect_interval(second.magnetometer.spec.variation.angle_offset_rad, -0.1, 0.2);
    EXPECT_EQ(root.entries.back().value.find("csv"), nullptr);  // has no effect
}

TEST(MagnetometerKeys, AnglesThatLookLikeAnotherUnitAreWarnings) {
    EXPECT_EQ(warnings_of("  world_field: {magnetic_north_angle: 1.57}\n"),
              "x.yaml:7: magnetometer.world_field.magnetic_north_angle: 1.57 degrees is unusually small; if you meant "
              "radians, write 89.9544\n");
    EXPECT_EQ(
        warnings_of("  angle_unit: rad\n  world_field: {magnetic_north_angle: 90}\n"),
        "x.yaml:8: magnetometer.world_field.magnetic_north_angle: 90 rad is unusually large; if you meant degrees, "
        "write 1.5708\n");
    EXPECT_EQ(warnings_of("  domain: {theta: [-3.14, 3.14]}\n"),
              "x.yaml:7: magnetometer.domain.theta.0: -3.14 degrees is unusually small, like another number of this "
              "list; if you meant radians, write -179.909\n");
    for (std::string const angles : {"  domain: {theta: [0, 360]}\n", "  robot_variation: {angle_offset: [-20, 20]}\n",
                                     "  procedural: {ellipse: {ellipse_rotation: [16.5]}}\n",
                                     "  procedural: {ellipse: {sensor_phase_offset: [7]}}\n",
                                     "  source: csv\n  csv: {file: a.csv, calibration_field_angle: 45}\n"}) {
        EXPECT_NE(warnings_of("  angle_unit: rad\n" + angles).find(" rad is unusually large"), std::string::npos)
            << angles;
        EXPECT_EQ(warnings_of(angles), "");
    }
    for (std::string const angles :
         {"  world_field: {magnetic_north_angle: 5}\n", "  world_field: {magnetic_north_angle: 0}\n",
          "  robot_variation: {angle_offset: [-1.5, 1.5]}\n", "  procedural: {ellipse: {ellipse_rotation: [1.5]}}\n",
          "  angle_unit: rad\n  domain: {theta: [0, 6.2832]}\n"}) {
        EXPECT_EQ(warnings_of(angles), "");
    }
}

TEST(MagnetometerKeys, MinorRadiusAboveTheMajorOneIsAWarning) {
    EXPECT_EQ(warnings_of("  procedural: {ellipse: {minor_radius: [170]}}\n"),
              "x.yaml:7: magnetometer.procedural.ellipse: minor_radius, [170], goes above major_radius, [160]: "
              "the long axis is then at 90 degrees to ellipse_rotation; if it should not be, exchange them\n");
    EXPECT_EQ(warnings_of("  procedural: {ellipse: {major_radius: [150, 170], minor_radius: [140, 160]}}\n"), "");
}

TEST(MagnetometerKeys, MapOfTheOtherSourceIsAWarning) {
    EXPECT_EQ(warnings_of("  csv: {file: a.csv}\n"),
              "x.yaml:7: magnetometer.csv: has no effect with source: procedural, the default; set source: csv, or "
              "remove it\n");
    EXPECT_EQ(warnings_of("  source: procedural\n  csv: {file: a.csv}\n"),
              "x.yaml:8: magnetometer.csv: has no effect with source: procedural; set source: csv, or remove it\n");
    EXPECT_EQ(warnings_of(kCsv + "  csv: {file: a.csv}\n  procedural: {ellipse: {major_radius: [5]}}\n"),
              "x.yaml:9: magnetometer.procedural: has no effect with source: csv; remove it, or set source: "
              "procedural\n");
    EXPECT_EQ(warnings_of("  csv: {}\n"), "");
}

TEST(MagnetometerKeys, SourceThatIsNoneIsAnErrorAlone) {
    Warnings const warnings;
    EXPECT_EQ(load_error(kRobots + "magnetometer: {source: CSV, csv: {file: a.csv}}\n"),
              "x.yaml:6: magnetometer.source: expected one of procedural, csv, csv_fit, found 'CSV'; did you mean "
              "'csv'?");
    EXPECT_EQ(warnings.text(), "");
}

TEST(MagnetometerKeys, OptionsOfABatchStandAnywhere) {
    Scenario const scenario = load(kRobots +
                                   "magnetometer:\n"
                                   "  source: {batch_options: [procedural, csv], default_option: procedural}\n"
                                   "  robot_variation:\n"
                                   "    signal_gain: {batch_options: [[1], [0.9, 1.1]], default_option: [0.9, 1.1]}\n"
                                   "    noise_stddev: {x: {batch_options: [[1], [2]], default_option: [2]}}\n");
    expect_interval(scenario.magnetometer.spec.variation.signal_gain, 0.9, 1.1);
    expect_interval(scenario.magnetometer.spec.variation.noise_stddev.x, 2.0, 2.0);
}

TEST(MagnetometerKeys, ValuesCanBeSetOnTheCommandLine) {
    Scenario const scenario =
        load(kRobots, {.overrides = {"magnetometer.procedural.ellipse.major_radius=[99]", "magnetometer.timing=robot"},
                       .strict = true});
    expect_interval(scenario.magnetometer.spec.ellipse.major_radius, 99.0, 99.0);
    EXPECT_EQ(scenario.magnetometer.spec.timing, MagnetometerTiming::robot);
}

TEST(MagnetometerKeys, RobotsHaveAMagnetometerUnlessTheirTypeHasNoneOrItIsTakenAway) {
    auto const robot_of = [](std::string const& entry) {
        return *load("objects:\n  a: {" + entry + "}\n").objects.front().spec.robot;
    };
    auto const finds_one = [&](std::string const& entry) {
        RobotSpec const robot = robot_of(entry);
        return robot.model.has_magnetometer && robot.magnetometer_enabled;
    };
    Warnings const warnings;
    EXPECT_TRUE(finds_one("type: pogobot"));
    EXPECT_TRUE(finds_one("type: active_object, geometry: disk"));
    EXPECT_FALSE(finds_one("type: pogobot, magnetometer_enabled: false"));
    EXPECT_FALSE(finds_one("type: pogobject, geometry: disk"));
    EXPECT_FALSE(finds_one("type: pogobject, geometry: disk, magnetometer_enabled: true"));
    EXPECT_FALSE(finds_one("type: pogowall, geometry: arena"));
    EXPECT_FALSE(finds_one("type: membrane, geometry: disk"));
    EXPECT_EQ(load_error("objects:\n  a: {type: pogobot, magnetometer_enabled: 3}\n"),
              "x.yaml:2: objects.a.magnetometer_enabled: expected true or false, found 3");
}

}  // namespace
