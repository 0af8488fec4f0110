#include "view/moment_history.hpp"

#include <gtest/gtest.h>

namespace pogosim {
namespace {

Moment moment_of(std::int64_t step, std::size_t bodies = 1) {
    Moment moment;
    moment.snapshot.step = step;
    moment.snapshot.time_s = 0.5 * static_cast<double>(step);
    moment.snapshot.position_mm.assign(bodies, {static_cast<float>(step), 0.0F});
    moment.snapshot.trails = std::make_shared<Trails const>();
    return moment;
}

TEST(MomentHistory, GivesTheLastMomentThatIsNotAfterATime) {
    MomentHistory history(100.0);
    EXPECT_TRUE(history.empty());
    for (std::int64_t const step : {2, 4, 8}) {
        history.add(moment_of(step));
    }
    EXPECT_EQ(history.first_s(), 1.0);
    EXPECT_EQ(history.last_s(), 4.0);
    EXPECT_EQ(history.at(0.0)->snapshot.step, 2);
    EXPECT_EQ(history.at(1.99)->snapshot.step, 2);
    EXPECT_EQ(history.at(2.0)->snapshot.step, 4);
    EXPECT_EQ(history.at(3.9)->snapshot.step, 4);
    EXPECT_EQ(history.at(99.0)->snapshot.step, 8);
    EXPECT_EQ(history.neighbour_s(4.0, -1), 2.0);
    EXPECT_EQ(history.neighbour_s(1.0, -1), 1.0);
    EXPECT_EQ(history.neighbour_s(2.0, 1), 4.0);
    EXPECT_EQ(history.neighbour_s(4.0, 1), 4.0);
    EXPECT_EQ(history.at(4.0)->snapshot.trails, nullptr);
}

TEST(MomentHistory, ForgetsWhatIsTooLongAgo) {
    MomentHistory history(10.0);
    for (std::int64_t step = 0; step <= 100; ++step) {
        history.add(moment_of(step));
    }
    EXPECT_EQ(history.first_s(), 40.0);
    EXPECT_EQ(history.last_s(), 50.0);
}

TEST(MomentHistory, ForgetsWhatCameAfterAStepBack) {
    MomentHistory history(100.0);
    for (std::int64_t const step : {0, 2, 4, 6}) {
        history.add(moment_of(step));
    }
    history.add(moment_of(3));
    EXPECT_EQ(history.last_s(), 1.5);
    EXPECT_EQ(history.at(99.0)->snapshot.step, 3);
    EXPECT_EQ(history.neighbour_s(1.5, -1), 1.0);
}

TEST(MomentHistory, NewMomentOfTheSameStepReplacesTheOneBefore) {
    MomentHistory history(100.0);
    history.add(moment_of(1));
    history.add(moment_of(1, 2));
    EXPECT_EQ(history.at(0.5)->snapshot.position_mm.size(), 2U);
    EXPECT_EQ(history.first_s(), history.last_s());
}

TEST(MomentHistory, OfALargeSwarmHasALimitOfMemory) {
    constexpr std::size_t kBodies = 1000000;
    MomentHistory history(1e9);
    for (std::int64_t step = 0; step < 100; ++step) {
        history.add(moment_of(step, kBodies));
    }
    EXPECT_EQ(history.last_s(), 49.5);
    EXPECT_LE((history.last_s() - history.first_s()) / 0.5 * kBodies * sizeof(Vec2),
              static_cast<double>(MomentHistory::kMostBytes));
    EXPECT_LT(history.first_s(), 49.0);
}

}  // namespace
}  // namespace pogosim
