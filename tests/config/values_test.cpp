#include "config/values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "config/tree.hpp"
#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

std::optional<double> number(std::string const& text) {
    return number_of(parse_yaml(text, "x.yaml"));
}

template <class T>
T value(std::string const& text, Limits const& limits = {}) {
    T value{};
    read_value({parse_yaml(text, "x.yaml"), "key"}, limits, value);
    return value;
}

template <class T>
std::string refusal(std::string const& text, Limits const& limits = {}) {
    return error_of([&] { value<T>(text, limits); });
}

}  // namespace

TEST(Values, NumbersOfEveryYamlFormAreRead) {
    EXPECT_EQ(number("12"), 12.0);
    EXPECT_EQ(number("-12.5"), -12.5);
    EXPECT_EQ(number("+.5"), 0.5);
    EXPECT_EQ(number("5."), 5.0);
    EXPECT_EQ(number("1.0e6"), 1.0e6);
    EXPECT_EQ(number("1E-3"), 1.0e-3);
    EXPECT_EQ(number("0x1F"), 31.0);
    EXPECT_EQ(number("0o17"), 15.0);
    EXPECT_EQ(number("010"), 10.0);
    EXPECT_EQ(number("'1.0e6'"), 1.0e6);
    EXPECT_EQ(number(".inf"), std::numeric_limits<double>::infinity());
    EXPECT_EQ(number("-.Inf"), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(*number(".NaN")));
}

TEST(Values, WhatIsNoNumberIsNone) {
    for (char const* text :
         {"many", "''",  ".",     "-",   "1e",  "1e+",   "e5",  "1.2.3", "12mm", "0x",     "0xG", "1 2",
          "inf",  "nan", "1_000", "--1", "+-1", "0x1p3", "1,5", "true",  "[1]",  "{a: 1}", "~",   "-.nan"}) {
        EXPECT_EQ(number(text), std::nullopt) << text;
    }
}

TEST(Values, IntegersDropTheFraction) {
    EXPECT_EQ(value<int>("150.0"), 150);
    EXPECT_EQ(value<int>("1e3"), 1000);
    EXPECT_EQ(value<int>("2.9"), 2);
    EXPECT_EQ(value<int>("-2.9"), -2);
    EXPECT_EQ(value<std::uint32_t>("4294967295"), 4294967295U);
    EXPECT_EQ(value<std::uint32_t>("-0.5"), 0U);
}

TEST(Values, IntegersStayInRangeAndType) {
    EXPECT_EQ(refusal<int>("3000000000"),
              "x.yaml:1: key: expected an integer from -2147483648 to 2147483647, found 3000000000");
    EXPECT_EQ(refusal<std::uint32_t>("-1"), "x.yaml:1: key: expected an integer from 0 to 4294967295, found -1");
    EXPECT_EQ(refusal<int>(".nan", {between(0, 9), ""}), "x.yaml:1: key: expected an integer from 0 to 9, found .nan");
    EXPECT_EQ(refusal<int>(".inf", {between(0, 9), ""}), "x.yaml:1: key: expected an integer from 0 to 9, found .inf");
    EXPECT_EQ(refusal<int>("1e400", {between(0, 9), ""}),
              "x.yaml:1: key: expected an integer from 0 to 9, found 1e400");
    EXPECT_EQ(refusal<int>("many", {between(0, 9), "robots"}),
              "x.yaml:1: key: expected an integer from 0 to 9 (robots), found 'many'");
}

TEST(Values, NumbersStayInRangeAsTheTypeHoldsThem) {
    EXPECT_EQ(refusal<double>("-3", {above(0), "mm"}), "x.yaml:1: key: expected a number above 0 (mm), found -3");
    EXPECT_EQ(refusal<float>("1e-60", {above(0), "mm"}), "x.yaml:1: key: expected a number above 0 (mm), found 1e-60");
    EXPECT_EQ(value<double>("1e-60", {above(0), "mm"}), 1e-60);
    EXPECT_EQ(refusal<float>("1e39", {at_least(0), ""}), "x.yaml:1: key: expected a number of at least 0, found 1e39");
    EXPECT_EQ(refusal<double>("[1]"), "x.yaml:1: key: expected a number, found a list");
    EXPECT_EQ(refusal<double>("{a: 1}"), "x.yaml:1: key: expected a number, found a map");
    EXPECT_EQ(refusal<double>("2", {above(0).up_to(1), ""}),
              "x.yaml:1: key: expected a number above 0, at most 1, found 2");
}

TEST(Values, NanAndInfinityPassOnlyWhereTheyAreWelcome) {
    for (char const* text : {".nan", ".inf", "-.inf"}) {
        EXPECT_NE(refusal<double>(text), "no error") << text;
    }
    EXPECT_TRUE(std::isnan(value<double>(".nan", {any().or_nan(), ""})));
    EXPECT_TRUE(std::isinf(value<float>(".inf", {above(0).or_infinity(), ""})));
    EXPECT_EQ(refusal<double>("-.inf", {above(0).or_infinity(), ""}),
              "x.yaml:1: key: expected a number above 0 or .inf, found -.inf");
}

TEST(Values, TruthHasSixWordsInAnyCaseAndTwoNumbers) {
    for (char const* text : {"true", "True", "YES", "on", "'true'", "1", "1.0"}) {
        EXPECT_TRUE(value<bool>(text)) << text;
    }
    for (char const* text : {"false", "No", "OFF", "0"}) {
        EXPECT_FALSE(value<bool>(text)) << text;
    }
    EXPECT_EQ(refusal<bool>("2"), "x.yaml:1: key: expected true or false, found 2");
    EXPECT_EQ(refusal<bool>("maybe"), "x.yaml:1: key: expected true or false, found 'maybe'");
}

TEST(Values, PairsHaveTwoNumbersInOrder) {
    EXPECT_EQ(value<Vec2>("[1, -2.5]"), (Vec2{1.0F, -2.5F}));
    EXPECT_EQ(refusal<Vec2>("[1]", {any(), "mm"}),
              "x.yaml:1: key: expected a list [x, y] of two numbers (mm), found a list of 1");
    EXPECT_EQ(refusal<Vec2>("[1, x]"), "x.yaml:1: key.1: expected a number, found 'x'");
    EXPECT_EQ(value<IntRange>("[-3, 4]").max, 4);
    EXPECT_EQ(refusal<IntRange>("[4, -3]"), "x.yaml:1: key: expected [smallest, largest], found [4, -3]");
}

TEST(Values, ListsOfNamesHoldSingleValues) {
    EXPECT_EQ(value<std::vector<std::string>>("[a, '', 3]"), (std::vector<std::string>{"a", "", "3"}));
    EXPECT_EQ(refusal<std::vector<std::string>>("a"), "x.yaml:1: key: expected a list of names, found 'a'");
    EXPECT_EQ(refusal<std::vector<std::string>>("[a, [b]]"), "x.yaml:1: key.1: expected a string, found a list");
}

TEST(Values, LongAndStrangeTextsAreShownOnOneShortLine) {
    EXPECT_EQ(shown("one\ntwo\tthree"), "one\\ntwo\\tthree");
    EXPECT_EQ(shown(std::string(100, 'x')), std::string(60, 'x') + "...");
    EXPECT_EQ(shown(std::string(59, 'x') + "\xC3\xA9 and more"), std::string(59, 'x') + "...");
    EXPECT_EQ(shown(std::string(58, 'x') + "\xC3\xA9"), std::string(58, 'x') + "\xC3\xA9");
}
