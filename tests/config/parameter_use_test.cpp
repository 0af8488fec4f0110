#include "config/parameter_use.hpp"

#include <gtest/gtest.h>

#include "config/yaml_text.hpp"

namespace pogosim {

namespace {

/// Names that are said to be unread once the program has asked for these.
std::string unread_after(std::vector<std::string> const& asked) {
    Node const parameters = parse_yaml("speed: 1\nphases: [{turn: {left: 1, right: 2}}, {turn: 3}]\n", "x.yaml");
    ParameterUse use(parameters);
    for (std::string const& name : asked) {
        use.ask(name);
    }
    return use.unread();
}

}  // namespace

TEST(ParameterUse, WhatTheProgramNeverAskedForIsNamedWithItsLine) {
    EXPECT_EQ(unread_after({}), "speed (x.yaml:1), phases (x.yaml:2)");
    EXPECT_EQ(unread_after({"phases"}), "speed (x.yaml:1)");
    EXPECT_EQ(unread_after({"speed", "phases"}), "");
}

TEST(ParameterUse, ListIsReadWhenAnythingInItIs) {
    for (char const* name : {"phases.0", "phases.1.turn", "phases.0.turn", "phases.0.turn.left"}) {
        EXPECT_EQ(unread_after({"speed", name}), "") << name;
    }
}

}  // namespace pogosim
