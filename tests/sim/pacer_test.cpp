#include "sim/pacer.hpp"

#include <gtest/gtest.h>

namespace pogosim {
namespace {

using namespace std::chrono_literals;
using Clock = Pacer::Clock;

double seconds(Clock::duration duration) {
    return std::chrono::duration<double>(duration).count();
}

TEST(Pacer, TenTimesRealTimeTakesATenthOfTheTime) {
    Pacer pacer(10.0);
    Clock::time_point const start = Clock::now();
    EXPECT_NEAR(seconds(pacer.due(0.0, 0.02, start) - start), 0.002, 1e-6);
    EXPECT_NEAR(seconds(pacer.due(4.98, 0.02, start + 450ms) - start), 0.5, 1e-6);
}

TEST(Pacer, WithoutALimitEveryStepIsDueAtOnce) {
    Pacer pacer(0.0);
    Clock::time_point const now = Clock::now();
    EXPECT_EQ(pacer.due(0.0, 0.01, now), now);
    EXPECT_EQ(pacer.due(1e6, 0.01, now), now);
    EXPECT_FALSE(pacer.is_too_slow());
}

TEST(Pacer, ALateRunDoesNotHurryAfterwards) {
    Pacer pacer(1.0);
    Clock::time_point const start = Clock::now();
    pacer.due(0.0, 0.5, start);
    Clock::time_point const late = start + 10s;
    EXPECT_EQ(pacer.due(0.5, 0.5, late), late);
    EXPECT_NEAR(seconds(pacer.due(1.0, 0.5, late) - late), 0.5, 1e-6);
}

TEST(Pacer, APauseDoesNotCount) {
    Pacer pacer(1.0);
    Clock::time_point const start = Clock::now();
    pacer.due(0.0, 0.01, start);
    pacer.start_anew();
    EXPECT_NEAR(seconds(pacer.due(0.0, 0.01, start + 60s) - start), 60.01, 1e-6);
}

TEST(Pacer, APauseIsNoSlowRun) {
    Pacer pacer(1.0);
    Clock::time_point const start = Clock::now();
    pacer.note_step(0.01, start);
    pacer.start_anew();
    pacer.note_step(0.02, start + 60s);
    pacer.note_step(0.52, start + 60s + 500ms);
    EXPECT_NEAR(pacer.reached(), 1.0, 1e-6);
    EXPECT_FALSE(pacer.is_too_slow());
}

TEST(Pacer, AnAbsurdlySlowRunWaits) {
    Pacer pacer(1e-300);
    Clock::time_point const now = Clock::now();
    EXPECT_GT(seconds(pacer.due(0.0, 0.01, now) - now), 1e6);
}

TEST(Pacer, TellsTheSpeedItReachesAndThatItIsLessThanAsked) {
    Pacer pacer(4.0);
    Clock::time_point now = Clock::now();
    for (int step = 1; step <= 200; ++step) {
        now += 10ms;
        pacer.note_step(0.02 * step, now);
    }
    EXPECT_NEAR(pacer.reached(), 2.0, 1e-6);
    EXPECT_TRUE(pacer.is_too_slow());
    pacer.set_speed_up(2.0);
    EXPECT_EQ(pacer.reached(), 0.0);
    EXPECT_FALSE(pacer.is_too_slow());
}

}  // namespace
}  // namespace pogosim
