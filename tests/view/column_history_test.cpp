#include "view/column_history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pogosim {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

TEST(ColumnHistory, BandReachesFromTheTenthToTheNinetiethPercentile) {
    ColumnHistory history(1, 11);
    RecordedValues recorded{.time_s = 0.5, .robot = {}, .values = {{}}};
    for (std::uint32_t robot = 0; robot < 11; ++robot) {
        recorded.robot.push_back(robot);
        recorded.values[0].push_back(static_cast<float>((robot * 7) % 11));  // 0 to 10 in another order
    }
    history.add(recorded);
    EXPECT_FLOAT_EQ(history.swarm(0).mean[0], 5.0F);
    EXPECT_FLOAT_EQ(history.swarm(0).low[0], 1.0F);
    EXPECT_FLOAT_EQ(history.swarm(0).high[0], 9.0F);
    EXPECT_EQ(history.times_s(), std::vector<double>{0.5});
}

TEST(ColumnHistory, RobotsWithoutAValueDoNotCount) {
    ColumnHistory history(1, 3);
    history.add({.time_s = 1.0, .robot = {0, 2}, .values = {{4.0F, kNone}}});
    EXPECT_FLOAT_EQ(history.swarm(0).mean[0], 4.0F);
    EXPECT_FLOAT_EQ(history.robot(0, 0)[0], 4.0F);
    EXPECT_TRUE(std::isnan(history.robot(0, 1)[0]));
    EXPECT_TRUE(std::isnan(history.robot(0, 2)[0]));
}

TEST(ColumnHistory, NoRobotHasNoMean) {
    ColumnHistory history(1, 0);
    history.add({.time_s = 1.0, .robot = {}, .values = {{}}});
    EXPECT_TRUE(std::isnan(history.swarm(0).mean[0]));
    EXPECT_TRUE(std::isnan(history.swarm(0).low[0]));
}

TEST(ColumnHistory, ALongRunKeepsEvenlySpacedTimesFromItsStart) {
    ColumnHistory history(2, 1);
    constexpr int kTimes = 50000;
    for (int i = 0; i < kTimes; ++i) {
        auto const value = static_cast<float>(i);
        history.add({.time_s = static_cast<double>(i), .robot = {0}, .values = {{value}, {-value}}});
    }
    auto const& times = history.times_s();
    ASSERT_LE(times.size(), ColumnHistory::kMostTimes);
    ASSERT_GE(times.size(), ColumnHistory::kMostTimes / 2);
    EXPECT_EQ(times.front(), 0.0);
    double const spacing = times[1] - times[0];
    std::vector<float> const values = history.robot(1, 0);
    for (std::size_t i = 0; i < times.size(); ++i) {
        ASSERT_EQ(times[i], static_cast<double>(i) * spacing);
        ASSERT_EQ(values[i], -static_cast<float>(times[i]));
        ASSERT_EQ(history.swarm(0).mean[i], static_cast<float>(times[i]));
    }
    EXPECT_GT(times.back(), kTimes - 1 - spacing);
}

}  // namespace
}  // namespace pogosim
