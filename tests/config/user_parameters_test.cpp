#include "config/user_parameters.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <vector>

#include "config/tree.hpp"
#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

constexpr double kLargest = std::numeric_limits<double>::max();

UserParameters parameters(parse_yaml(
    "run_duration_min: 1000\nratio: 0.25\nback: yes\nname: Ada\nvect: [1, 2.5, 3]\nfloat_text: '12.9'\nword: fast\n"
    "empty: []\nnothing:\np: {k: 7, list: [4, 5]}\na.b: 8\nbig: 1e40\nmap: {x: 1}\nmixed: [1, two]\n"
    "infinite: -.inf\nfar: [1, -1e39]\n",
    "x.yaml"));

/// Names that are said to be unread once the program has asked for these.
std::string unread_after(std::vector<std::string> const& asked) {
    UserParameters several(parse_yaml("speed: 1\nphases: [{turn: {left: 1, right: 2}}, {turn: 3}]\n", "x.yaml"));
    for (std::string const& name : asked) {
        try {
            several.text(name, 100);
        } catch (ConfigError const&) {  // a map or a list: it has been asked for
        }
    }
    return several.unread().all;
}

}  // namespace

TEST(UserParameters, ValuesAreFoundByNameAndPath) {
    EXPECT_EQ(parameters.integer("run_duration_min", 0, 4294967295), 1000);
    EXPECT_EQ(parameters.number("ratio", kLargest), 0.25);
    EXPECT_EQ(parameters.boolean("back"), true);
    EXPECT_EQ(parameters.text("name", 100), "Ada");
    EXPECT_EQ(parameters.text("run_duration_min", 100), "1000");
    EXPECT_EQ(parameters.integer("p.k", 0, 255), 7);
    EXPECT_EQ(parameters.integer("p.list.1", 0, 255), 5);
    EXPECT_EQ(parameters.integer("a.b", 0, 255), 8);
    EXPECT_EQ(parameters.integer("float_text", 0, 255), 12);
    EXPECT_EQ(parameters.integer("back", 0, 255), 1);
    EXPECT_EQ(parameters.number("big", kLargest), 1e40);
}

TEST(UserParameters, AbsentAndNullLeaveTheProgramsDefault) {
    for (char const* name : {"unknown", "nothing", "p.unknown", "", "ratio.x"}) {
        EXPECT_EQ(parameters.integer(name, 0, 255), std::nullopt) << name;
        EXPECT_EQ(parameters.number(name, kLargest), std::nullopt) << name;
        EXPECT_EQ(parameters.boolean(name), std::nullopt) << name;
        EXPECT_EQ(parameters.text(name, 100), std::nullopt) << name;
        EXPECT_EQ(parameters.numbers(name, 3, kLargest), std::nullopt) << name;
    }
    EXPECT_EQ(UserParameters(Node{}).number("ratio", kLargest), std::nullopt);
}

TEST(UserParameters, WrongTypesAreErrorsWithTheirLine) {
    EXPECT_EQ(error_of([] { parameters.integer("word", 0, 4294967295); }),
              "x.yaml:7: parameters.word: expected an integer from 0 to 4294967295, found 'fast'");
    EXPECT_EQ(error_of([] { parameters.integer("run_duration_min", 0, 255); }),
              "x.yaml:1: parameters.run_duration_min: expected an integer from 0 to 255, found 1000");
    EXPECT_EQ(error_of([] { parameters.number("word", kLargest); }),
              "x.yaml:7: parameters.word: expected a number, found 'fast'");
    EXPECT_EQ(error_of([] { parameters.boolean("ratio"); }),
              "x.yaml:2: parameters.ratio: expected true or false, found 0.25");
    EXPECT_EQ(error_of([] { parameters.text("map", 100); }),
              "x.yaml:13: parameters.map: expected a string, found a map");
}

TEST(UserParameters, NumbersThatDoNotFitAFloatAreErrorsInAFloat) {
    constexpr double kLargestFloat = std::numeric_limits<float>::max();
    EXPECT_EQ(parameters.number("ratio", kLargestFloat), 0.25);
    EXPECT_EQ(parameters.number("infinite", kLargestFloat), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(error_of([] { parameters.number("big", kLargestFloat); }),
              "x.yaml:12: parameters.big: expected a number from -3.4028234663852886e+38 to 3.4028234663852886e+38, "
              "found 1e40");
    EXPECT_EQ(error_of([] { parameters.numbers("far", 2, kLargestFloat); }),
              "x.yaml:16: parameters.far.1: expected a number from -3.4028234663852886e+38 to 3.4028234663852886e+38, "
              "found -1e39");
}

TEST(UserParameters, ListsGiveTheirFirstNumbers) {
    EXPECT_EQ(parameters.numbers("vect", 3, kLargest), (std::vector{1.0, 2.5, 3.0}));
    EXPECT_EQ(parameters.numbers("vect", 2, kLargest), (std::vector{1.0, 2.5}));
    EXPECT_EQ(parameters.numbers("empty", 2, kLargest), std::nullopt);
    EXPECT_EQ(error_of([] { parameters.numbers("vect", 4, kLargest); }),
              "x.yaml:5: parameters.vect: expected a list of at least 4 numbers, found 3");
    EXPECT_EQ(error_of([] { parameters.numbers("ratio", 4, kLargest); }),
              "x.yaml:2: parameters.ratio: expected a list of at least 4 numbers, found 0.25");
    EXPECT_EQ(error_of([] { parameters.numbers("mixed", 2, kLargest); }),
              "x.yaml:14: parameters.mixed.1: expected a number, found 'two'");
}

TEST(UserParameters, WhatTheProgramNeverAskedForIsNamedWithItsLine) {
    EXPECT_EQ(unread_after({}), "speed (x.yaml:1), phases (x.yaml:2)");
    EXPECT_EQ(unread_after({"phases"}), "speed (x.yaml:1)");
    EXPECT_EQ(unread_after({"speed", "phases"}), "");
}

TEST(UserParameters, ListIsReadWhenAnythingInItIs) {
    for (char const* name : {"phases.0", "phases.1.turn", "phases.0.turn", "phases.0.turn.left"}) {
        EXPECT_EQ(unread_after({"speed", name}), "") << name;
    }
}

TEST(UserParameters, NameThatIsNearToSeveralUnreadOnesIsNoSlipOfThem) {
    UserParameters near_both(parse_yaml("turn_mx: 1\nturn_mix: 2\nwalk_sped: 3\n", "x.yaml"));
    near_both.text("turn_max", 100);
    near_both.text("walk_speed", 100);
    EXPECT_EQ(near_both.unread().all,
              "turn_mx (x.yaml:1), turn_mix (x.yaml:2), walk_sped (x.yaml:3; did you mean 'walk_speed'?)");
}

TEST(UserParameters, UnreadOneOfTheCommandLineIsNamedWithWhatTheProgramReads) {
    Node tree = parse_yaml("use_compass: true\nuse_compas: false\nof_others: 1\n", "x.yaml");
    for (char const* const text : {"use_kompass=false", "traits=5", "speed=1", "colour=red"}) {
        apply_override(tree, text);
    }
    UserParameters given(tree);
    for (char const* const name : {"use_compass", "nb_traits", "walk.speed", "turn.speed"}) {
        given.text(name, 100);
    }
    // One of the file may be for another program that reads both; "speed" may be either.
    EXPECT_EQ(given.unread().brief,
              "use_kompass (--set; did you mean 'use_compass'?), traits (--set; did you mean 'nb_traits'?), "
              "speed (--set), colour (--set) and 2 more (-v lists them)");
}
