// Slips in the keys with which a configuration offers alternatives.
#include <gtest/gtest.h>

#include <string>

#include "config/config_file.hpp"
#include "config/option_keys.hpp"
#include "config/reference.hpp"
#include "config/tree.hpp"
#include "config/user_parameters.hpp"
#include "lamps/lamp_types.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

std::string checked(std::string const& text) {
    return error_of([&] {
        Problems problems;
        check_options(parse_yaml(text, "x.yaml"), problems);
        problems.throw_if_any();
    });
}

/// The end of the message on an unknown key of a map of options without a near one.
std::string const kWords = "; known are default_option, batch_options, batch_options_range, optimization_domain";

}  // namespace

TEST(MisspeltOption, BesideAnotherIsRefusedWithItsLineAlsoWithoutStrict) {
    std::string const text = kRobots + "    nb:\n      batch_option: [3, 4]\n      default_option: 3\n";
    for (bool const strict : {false, true}) {
        EXPECT_EQ(load_error(text, {.overrides = {}, .strict = strict}),
                  "x.yaml:7: objects.robots.nb: unknown key 'batch_option' beside 'default_option'; did you mean "
                  "'batch_options'?");
    }
    EXPECT_EQ(checked("a: {batch_options: [1], defalt_option: 1}\n"),
              "x.yaml:1: a: unknown key 'defalt_option' beside 'batch_options'; did you mean 'default_option'?");
    EXPECT_EQ(checked("a: {default_option: 1, radius: 2}\n"),
              "x.yaml:1: a: unknown key 'radius' beside 'default_option'" + kWords);
}

TEST(MisspeltOption, AloneIsRefusedWhereTheSimulatorChoosesTheKeys) {
    EXPECT_EQ(checked("objects: {robots: {nb: {batch_option: [3, 4], defalt_option: 3}}}\n"),
              "x.yaml:1: objects.robots.nb: unknown key 'batch_option'; did you mean 'batch_options'?");
    EXPECT_EQ(checked("a: {Default_Option: 3}\n"),
              "x.yaml:1: a: unknown key 'Default_Option'; did you mean 'default_option'?");
    EXPECT_EQ(checked("a: {optimisation_domain: {min: 0}}\n"),
              "x.yaml:1: a: unknown key 'optimisation_domain'; did you mean 'optimization_domain'?");
    EXPECT_EQ(checked("objects:\n  batch_hierarchical_option: {default: {}}\n"),
              "x.yaml:2: objects: unknown key 'batch_hierarchical_option'; did you mean 'batch_hierarchical_options'?");
    EXPECT_EQ(checked("batch_hierachical_options: {default: {}}\n"),
              "x.yaml:1: the top level: unknown key 'batch_hierachical_options'; did you mean "
              "'batch_hierarchical_options'?");
}

TEST(MisspeltOption, OfARangeOrADomainIsRefused) {
    EXPECT_EQ(checked("a: {default_option: 1, batch_options_range: {start: 0, stop: 1, steps: 1}}\n"),
              "x.yaml:1: a.batch_options_range: unknown key 'steps'; did you mean 'step'?");
    EXPECT_EQ(checked("a:\n  optimization_domain:\n    maxi: 3\n"),
              "x.yaml:3: a.optimization_domain: unknown key 'maxi'; did you mean 'max'?");
    EXPECT_EQ(checked("a: {optimization_domain: {x: 3}}\n"),
              "x.yaml:1: a.optimization_domain: unknown key 'x'; known are type, min, max, init, log, choices");
}

TEST(ValuesOfOptions, MustBeAListOfAtLeastOne) {
    std::string const begin = "x.yaml:1: a: batch_options: expected ";
    EXPECT_EQ(checked("a: {batch_options: []}\n"), begin + "at least one value, found an empty list");
    EXPECT_EQ(checked("a: {batch_options: 3}\n"), begin + "a list of values, found 3; write [3]");
    EXPECT_EQ(checked("a: {default_option: 1, batch_options: {a: 1}}\n"), begin + "a list of values, found a map");
    EXPECT_EQ(checked("a: {default_option: 1, batch_options: }\n"), begin + "a list of values, found nothing");
    EXPECT_EQ(load_error(kRobots + "    nb: {batch_options: []}\n"),
              "x.yaml:6: objects.robots.nb: batch_options: expected at least one value, found an empty list");
    EXPECT_EQ(checked("a: {batch_options: [1], batch_options_range: {start: 0, stop: 1, step: 1}}\n"),
              "x.yaml:1: a: expected either batch_options or batch_options_range, found both; remove one");
}

TEST(ValuesOfOptions, AreAllDifferent) {
    auto const twice = [](std::string const& found) {
        return "x.yaml:1: a.batch_options: expected different values, found " + found +
               "; their runs would be the same: remove one";
    };
    EXPECT_EQ(checked("a: {batch_options: [3, 4, 3]}\n"), twice("3 twice"));
    EXPECT_EQ(checked("a: {batch_options: [3, 3.0]}\n"), twice("3 and 3.0, which are the same"));
    EXPECT_EQ(checked("a: {batch_options: [0x10, 16]}\n"), twice("0x10 and 16, which are the same"));
    EXPECT_EQ(checked("a: {batch_options: [true, TRUE]}\n"), twice("'true' and 'TRUE', which are the same"));
    EXPECT_EQ(checked("a: {batch_options: [~, null]}\n"), twice("nothing twice"));
    EXPECT_EQ(checked("a: {batch_options: [[1, [2]], [1.0, [2]]]}\n"), twice("a list twice"));
    EXPECT_EQ(checked("a:\n  batch_options:\n    - disk\n    - disk\n"),
              "x.yaml:4: a.batch_options: expected different values, found 'disk' twice; their runs would be the same: "
              "remove one");
    EXPECT_EQ(checked("a: {optimization_domain: {choices: [1, 1]}}\n"),
              "x.yaml:1: a.optimization_domain.choices: expected different values, found 1 twice; their runs would be "
              "the same: remove one");
    EXPECT_EQ(checked("a: {batch_options: [1, true, '1.0', yes, [1], [[1]], {b: 1}, {c: 1}, ['1', '2'], ['1 2']]}\n"),
              "no error");
    EXPECT_EQ(checked("a: {batch_options_range: {start: 1, stop: 1.0000000000000004, step: 1e-17}}\n"),
              "x.yaml:1: a: batch_options_range: a step of 1e-17 is too small to tell values apart; give a larger one");
}

TEST(ValuesOfOptions, OfARangeMustBeThere) {
    auto const range = [](std::string const& words) {
        std::string const message = checked("a: {batch_options_range: " + words + "}\n");
        std::string const begin = "x.yaml:1: a: batch_options_range: ";
        return message.starts_with(begin) ? message.substr(begin.size()) : message;
    };
    EXPECT_EQ(range("3"), "expected a map, such as {start: 0, stop: 10, step: 1}, found 3");
    EXPECT_EQ(range(""), "expected a map, such as {start: 0, stop: 10, step: 1}, found nothing");
    EXPECT_EQ(range("{start: 0, step: 1}"), "'stop' is missing; expected start, stop and step");
    EXPECT_EQ(range("{start: a, stop: 1, step: 1}"), "start: expected a number, found 'a'");
    EXPECT_EQ(range("{start: 0, stop: .inf, step: 1}"), "stop: expected a number, found .inf");
    EXPECT_EQ(range("{start: 0, stop: 1, step: 0}"), "step is 0; give a step from start towards stop");
    EXPECT_EQ(range("{start: 0, stop: 1, step: -1}"),
              "there is no value from 0 to 1 in steps of -1; give another stop, a step of the other sign, or "
              "inclusive: true");
    EXPECT_TRUE(range("{start: 0, stop: 0, step: 1}").starts_with("there is no value from 0 to 0"));
    EXPECT_EQ(range("{start: 0, stop: 0, step: 1, inclusive: true}"), "no error");
    EXPECT_EQ(range("{start: 0, stop: 1, step: 1, inclusive: 3}"), "inclusive: expected true or false, found 3");
    EXPECT_EQ(range("{start: 0, stop: 1e9, step: 1}"), "there are more than 1000000 values; give a larger step");
    EXPECT_EQ(range("{start: 0, stop: 1, step: 1, type: text}"), "type: expected int or float, found 'text'");
    EXPECT_EQ(range("{start: 0, stop: 1, step: 0.5, type: int}"),
              "type is int, but start 0 or step 0.5 is not a whole number");
}

TEST(MisspeltOption, IsFoundInAlternativesThatASingleRunDoesNotTake) {
    std::string const wrong = "{batch_option: [1], default_option: 1}";
    std::string const message = ": unknown key 'batch_option' beside 'default_option'; did you mean 'batch_options'?";
    EXPECT_EQ(checked("o: {batch_hierarchical_options: {default: {}, other: {nb: " + wrong + "}}}\n"),
              "x.yaml:1: o.batch_hierarchical_options.other.nb" + message);
    EXPECT_EQ(checked("a: {default_option: 1, batch_options: [1, {b: " + wrong + "}]}\n"),
              "x.yaml:1: a.batch_options.1.b" + message);
    EXPECT_EQ(checked("a: {optimization_domain: {choices: [" + wrong + "]}}\n"),
              "x.yaml:1: a.optimization_domain.choices.0" + message);
    EXPECT_EQ(checked("a: {default_option: " + wrong + "}\n"), "x.yaml:1: a.default_option" + message);
    EXPECT_EQ(checked("objects: {lamp: [{x: 1}, {x: " + wrong + "}]}\n"), "x.yaml:1: objects.lamp.1.x" + message);
    EXPECT_EQ(checked("parameters: {law: {speed: " + wrong + "}}\n"), "x.yaml:1: parameters.law.speed" + message);
}

TEST(MisspeltOption, IsFoundWhereAnAlternativeMeetsItsMap) {
    EXPECT_EQ(load_error(kRobots + "    nb: {radius: 3, batch_hierarchical_options: {default: {default_option: 3}}}\n"),
              "x.yaml:6: objects.robots.nb: unknown key 'radius' beside 'default_option'" + kWords);
    EXPECT_EQ(load_error(kRobots + "    nb: {default_option: 3, batch_hierarchical_options: {default: "
                                   "{batch_options: [3, 4]}}}\n"),
              "no error");
}

TEST(MisspeltOption, OfSetIsRefusedToo) {
    EXPECT_EQ(load_error(kRobots, {.overrides = {"objects.robots.nb={default_option: 3, batch_optoins: [3]}"}}),
              "--set: objects.robots.nb: unknown key 'batch_optoins' beside 'default_option'; did you mean "
              "'batch_options'?");
}

TEST(Alternatives, ThatAreNoMapsAreRefused) {
    EXPECT_EQ(
        checked("o:\n  batch_hierarchical_options:\n    nmae: scene\n    default: {}\n"),
        "x.yaml:3: o.batch_hierarchical_options.nmae: expected a map of keys and values, found 'scene'; did you mean "
        "'name'?");
    EXPECT_EQ(checked("o: {batch_hierarchical_options: {names: scene, default: {}}}\n"),
              "x.yaml:1: o.batch_hierarchical_options.names: expected a map of keys and values, found 'scene'; did you "
              "mean 'name'?");
    EXPECT_EQ(checked("o: {batch_hierarchical_options: {one: null, default: {}}}\n"), "no error");
}

TEST(Alternatives, WithAMisspeltDefaultAreRefused) {
    EXPECT_EQ(checked("o: {batch_hierarchical_options: {defualt: {}, other: {}}}\n"),
              "x.yaml:1: o.batch_hierarchical_options: there is no 'default', which a single run takes; did you mean "
              "'default', not 'defualt'?");
    EXPECT_EQ(checked("o: {batch_hierarchical_options: {defaults: {}, default: {}}}\n"), "no error");
}

TEST(NamesOfTheUser, MayBeLikeThoseOfOptions) {
    for (char const* const text :
         {"parameters: {law: {default_action: 1, batch_option: 2}}\n",
          "parameters: {list: [{batch_option: 2}, {batch_option: [2], other: 3}]}\n",
          "parameters: {name: x, default: 1, type: y, min: 2, choices: []}\n",
          "objects: {default_action: {nb: 1}, batch_option: {nb: 2}}\n",
          "o: {batch_hierarchical_options: {default: {}, default_option_s: {}, batch_option: {}}}\n",
          "default_action: forward\no: {batch_hierarchical_options: {name: default_action, default: {}}}\n",
          "_batch_choice_names: {batch_option: a}\n",
          "optimization: {batch_option: 1, default_option: 2, other: 3}\n"}) {
        EXPECT_EQ(checked(text), "no error") << text;
    }
}

TEST(NamesOfTheSimulator, AreNotLikeThoseOfOptions) {
    for (KeyGroup const& group : configuration_reference(object_types())) {
        for (KeyDescription const& key : group.keys) {
            EXPECT_EQ(misspelt_option(key.name), "") << key.name;
        }
    }
}

TEST(MisspeltOption, OfAParameterIsRefusedWhereAllOfItsMapLooksLikeOptions) {
    EXPECT_EQ(checked("parameters: {speed: {batch_option: [1, 2], defalt_option: 1}}\n"),
              "x.yaml:1: parameters.speed: unknown key 'batch_option'; did you mean 'batch_options'?");
    EXPECT_EQ(checked("parameters: {speed: {optimisation_domain: {min: 1}}}\n"),
              "x.yaml:1: parameters.speed: unknown key 'optimisation_domain'; did you mean 'optimization_domain'?");
    EXPECT_EQ(
        checked("parameters: {a: 1, batch_hierarchical_option: {one: {a: 2}}}\n"),
        "x.yaml:1: parameters: unknown key 'batch_hierarchical_option'; did you mean 'batch_hierarchical_options'?");
}

TEST(MisspeltOption, IsToldWhereAParameterIsReadAsANumber) {
    Folder const folder;
    Folder::write("x.yaml", kRobots + "parameters:\n  speed: {defalt_option: 1}\n");
    UserParameters parameters(load_scenario("x.yaml", {}, object_types()), Conversions::lenient);
    EXPECT_EQ(parameters.unread().all, "speed.defalt_option (x.yaml:7; did you mean 'default_option'?)");
    EXPECT_EQ(error_of([&] { static_cast<void>(parameters.number("speed", 1e9)); }),
              "x.yaml:7: parameters.speed: expected a number, found a map; did you mean 'default_option', not "
              "'defalt_option'?");
}
