#include "sim/condition.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::square_world;

/// Robots at x = 100, 200 and 300 mm, y = 50 mm, without a column of the program.
class ConditionTest : public ::testing::Test {
protected:
    ConditionTest() : world_(square_world()) {
        for (float const x : {100.0F, 200.0F, 300.0F}) {
            add_robot(world_, {x, 50.0F});
        }
    }

    std::optional<std::size_t> first(std::string const& text) {
        RobotValues const values(world_, columns_);
        return Condition(text, values.names()).first_robot(values);
    }

    std::string error(std::string const& text) {
        try {
            Condition(text, RobotValues(world_, columns_).names());
        } catch (ConfigError const& problem) {
            return problem.what();
        }
        return "";
    }

    World world_;
    SavedColumns columns_;
};

TEST_F(ConditionTest, IsTrueOfTheFirstRobotThatItFits) {
    EXPECT_EQ(first("x > 150"), 1U);
    EXPECT_EQ(first("x >= 100"), 0U);
    EXPECT_EQ(first("x > 300"), std::nullopt);
    EXPECT_EQ(first("x == 300"), 2U);
    EXPECT_EQ(first("x != 100"), 1U);
    EXPECT_EQ(first("speed < 1"), 0U);
}

TEST_F(ConditionTest, IsTrueOfOtherRobotsWhenTheWorldHasChanged) {
    RobotValues const values(world_, columns_);
    Condition condition("x > 250", values.names());
    EXPECT_EQ(condition.first_robot(values), 2U);
    world_.bodies.position_mm[1].x = 260.0F;
    EXPECT_EQ(condition.first_robot(values), 1U);
}

TEST_F(ConditionTest, OperatorsBindAsInArithmetic) {
    EXPECT_EQ(first("x + 2 * y > 299"), 1U);  // 200, 300
    EXPECT_EQ(first("(x + 2) * y == 10100"), 1U);
    EXPECT_EQ(first("x - 100 - 100 == 0"), 1U);
    EXPECT_EQ(first("x / 2 / 50 == 3"), 2U);
    EXPECT_EQ(first("-x < -250"), 2U);
    EXPECT_EQ(first("abs(200 - x) > 50 and x > 150"), 2U);
    EXPECT_EQ(first("x == 300 or x == 200"), 1U);
    EXPECT_EQ(first("x == 300 or x == 200 and y > 60"), 2U);  // 'and' binds more strongly
    EXPECT_EQ(first("(x == 300 or x == 200) and y > 60"), std::nullopt);
    EXPECT_EQ(first("not x < 200"), 1U);
    EXPECT_EQ(first("not not x == 200"), 1U);
    EXPECT_EQ(first("x > 1.5e2"), 1U);
}

TEST_F(ConditionTest, ComparisonWithNoValueIsFalse) {
    EXPECT_EQ(first("0 / 0 == 0 / 0"), std::nullopt);
    EXPECT_EQ(first("0 / 0 != 1"), std::nullopt);
    EXPECT_EQ(first("0 / 0"), std::nullopt);
    EXPECT_EQ(first("0 / 0 or 0 / 0"), std::nullopt);
    EXPECT_EQ(first("x > 0 and 0 / 0"), std::nullopt);
    EXPECT_EQ(first("not 0 / 0"), 0U);
}

TEST_F(ConditionTest, WhatIsNoConditionIsToldWithItsPlace) {
    EXPECT_EQ(error("x >"), "'x >', character 4: expected a value or a number");
    EXPECT_EQ(error("x > 1 y"), "'x > 1 y', character 7: expected 'and', 'or', an operator or the end");
    EXPECT_EQ(error("(x > 1"), "'(x > 1', character 7: expected ')'");
    EXPECT_EQ(
        error("sped > 1"),
        "'sped > 1', character 1: there is no value 'sped': expected one of speed, x, y, angle, light; did you mean "
        "'speed'?");
    EXPECT_EQ(error("x > 1 & y > 2"), "'x > 1 & y > 2', character 7: expected 'and', 'or', an operator or the end");
    EXPECT_NE(error(std::string(500, '(')).find("too many brackets"), std::string::npos);
    EXPECT_NE(error(std::string(500, '-')).find("too many brackets"), std::string::npos);
    std::string nots;
    for (int i = 0; i < 200; ++i) {
        nots += "not ";
    }
    EXPECT_NE(error(nots).find("too many brackets"), std::string::npos);
    EXPECT_NE(error(""), "");
}

TEST_F(ConditionTest, NamesAreThoseInIt) {
    EXPECT_EQ(Condition("x > 1 and y < x", {"x", "y", "xy"}).names(), (std::vector<std::string>{"x", "y"}));
    EXPECT_EQ(Condition("xy > 1", {"x", "xy"}).names(), std::vector<std::string>{"xy"});
    EXPECT_EQ(Condition("abs > 1 or abs(abs) < 2", {"abs"}).names(), std::vector<std::string>{"abs"});
    EXPECT_EQ(Condition("my column > 1", {"my column"}).names(), std::vector<std::string>{"my column"});
}

TEST_F(ConditionTest, IsANumberForEachRobot) {
    std::vector<float> const x{1.0F, -2.0F, NAN};
    std::vector<float> const y{4.0F, 5.0F, 6.0F};
    std::vector<float const*> const values{y.data(), x.data()};  // as its names
    std::vector<float> numbers(3);
    Condition("y / abs(x) + (x < 0)", {"x", "y"}).evaluate(values, numbers);
    EXPECT_EQ(numbers[0], 4.0F);
    EXPECT_EQ(numbers[1], 3.5F);
    EXPECT_TRUE(std::isnan(numbers[2]));
    Condition("1 / 0", {}).evaluate({}, numbers);
    EXPECT_TRUE(std::isinf(numbers[2]));
}

TEST_F(ConditionTest, HasAtMostAThousandCharacters) {
    std::string text = "x";
    while (text.size() < 996) {
        text += "+1";
    }
    EXPECT_EQ(error(text + ">1"), "");
    EXPECT_NE(error(text + "+1+1>1").find("an expression has at most 1000 characters, found 1003"), std::string::npos);
}

TEST_F(ConditionTest, OfALongOneThePartAroundAMistakeIsShown) {
    std::string const sums(200, ' ');
    EXPECT_EQ(error(sums + "x > nowhere" + sums),
              "'..." + std::string(36, ' ') + "x > nowhere" + std::string(33, ' ') +
                  "...', character 205: there is no value 'nowhere': expected one of speed, x, y, angle, light");
}

}  // namespace
}  // namespace pogosim
