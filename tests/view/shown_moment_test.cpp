#include "view/shown_moment.hpp"

#include <gtest/gtest.h>

namespace pogosim {
namespace {

Moment moment_of(std::int64_t step) {
    Moment moment;
    moment.snapshot.step = step;
    moment.snapshot.time_s = 0.5 * static_cast<double>(step);
    return moment;
}

class ShownMomentTest : public ::testing::Test {
protected:
    ShownMomentTest() {
        for (std::int64_t const step : {2, 4, 6}) {
            shown_.take(moment_of(step), false);
        }
    }

    std::int64_t step_shown() {
        shown_.choose();
        return shown_.on_screen().snapshot.step;
    }

    ShownMoment shown_{100.0};
};

TEST_F(ShownMomentTest, IsTheNewestUntilTheUserLooksBack) {
    EXPECT_EQ(step_shown(), 6);
    EXPECT_TRUE(shown_.look_at(2.2));
    EXPECT_EQ(step_shown(), 4);
    shown_.take(moment_of(8), false);
    EXPECT_EQ(step_shown(), 4);
    EXPECT_EQ(shown_.newest()->snapshot.step, 8);
    shown_.look_at_newest();
    EXPECT_EQ(step_shown(), 8);
}

TEST_F(ShownMomentTest, NeighboursEndAtTheFirstAndTheNewest) {
    EXPECT_TRUE(shown_.look_at_neighbour(-1));
    EXPECT_EQ(step_shown(), 4);
    EXPECT_TRUE(shown_.look_at_neighbour(-1));
    EXPECT_TRUE(shown_.look_at_neighbour(-1));
    EXPECT_EQ(step_shown(), 2);
    EXPECT_TRUE(shown_.look_at_neighbour(1));
    EXPECT_FALSE(shown_.look_at_neighbour(1));
    EXPECT_EQ(shown_.past_time_s(), std::nullopt);
    EXPECT_EQ(step_shown(), 6);
}

TEST_F(ShownMomentTest, StaysOnTheScreenUntilTheNextPicture) {
    shown_.choose();
    shown_.look_at(1.0);
    EXPECT_EQ(shown_.on_screen().snapshot.step, 6);
}

TEST_F(ShownMomentTest, NothingIsLookedAtBeforeTheFirstMoment) {
    ShownMoment none(100.0);
    EXPECT_FALSE(none.look_at(0.0));
    EXPECT_FALSE(none.look_at_neighbour(-1));
    EXPECT_EQ(none.newest(), nullptr);
}

TEST_F(ShownMomentTest, HasTheTrailsOfAnEarlierMomentUntilTheyAreOldOrHidden) {
    EXPECT_FALSE(shown_.has_fresh_trails());
    Moment with_trails = moment_of(8);
    with_trails.snapshot.trails = std::make_shared<Trails const>();
    shown_.take(with_trails, true);
    EXPECT_TRUE(shown_.has_fresh_trails());
    shown_.take(moment_of(9), true);  // half a second later
    EXPECT_EQ(shown_.newest()->snapshot.trails, with_trails.snapshot.trails);
    EXPECT_FALSE(shown_.has_fresh_trails());
    shown_.take(moment_of(10), false);
    EXPECT_EQ(shown_.newest()->snapshot.trails, nullptr);
}

}  // namespace
}  // namespace pogosim
