// When rows are recorded, and the times that they bear.
#include "sim/due_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace pogosim {
namespace {

/// Times of the rows of a run, s, and the steps after which they are recorded.
struct Rows {
    std::vector<double> time_s;
    std::vector<std::int64_t> step;
};

Rows rows_of(RowTiming timing, double period_s, double time_step_s, int steps) {
    RowTimes times(timing, period_s);
    World world;
    world.time_step_s = time_step_s;
    Rows rows;
    for (world.step = 0; world.step <= steps; ++world.step) {
        if (auto const due_s = times.due(world)) {
            rows.time_s.push_back(std::round(1e4 * *due_s) / 1e4);
            rows.step.push_back(world.step);
        }
    }
    return rows;
}

TEST(RowTimes, AreMultiplesOfThePeriod) {
    Rows const rows = rows_of(RowTiming::multiples, 1.0, 0.01, 350);
    EXPECT_EQ(rows.time_s, (std::vector{0.0, 1.0, 2.0, 3.0}));
    EXPECT_EQ(rows.step, (std::vector<std::int64_t>{0, 100, 200, 300}));
}

TEST(RowTimes, OfTheOriginalDrift) {
    Rows const rows = rows_of(RowTiming::original, 1.0, 0.01, 350);
    EXPECT_EQ(rows.time_s, (std::vector{0.0, 1.01, 2.02, 3.03}));
    // At the end of the step that began at this time.
    EXPECT_EQ(rows.step, (std::vector<std::int64_t>{0, 102, 203, 304}));
}

TEST(RowTimes, OfTheOriginalAreEvenIfTheSumIsExact) {
    Rows const rows = rows_of(RowTiming::original, 0.5, 0.125, 13);
    EXPECT_EQ(rows.time_s, (std::vector{0.0, 0.5, 1.0, 1.5}));
}

TEST(RowTimes, WithoutAPeriodThereIsTimeZeroOnly) {
    EXPECT_EQ(rows_of(RowTiming::multiples, 0.0, 0.01, 300).step.size(), 1U);
    EXPECT_EQ(rows_of(RowTiming::original, -1.0, 0.01, 300).step.size(), 1U);
}

}  // namespace
}  // namespace pogosim
