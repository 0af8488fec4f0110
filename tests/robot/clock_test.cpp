// A robot's own time: ticks, sleeping, stopwatches and timers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

/// A run of one robot; the test's functions note what they see in static variables.
std::unique_ptr<Simulation> run_one(void (*init)(), void (*step)(), double seconds) {
    testing::use_program(init, step);
    auto simulation = std::make_unique<Simulation>(testing::test_program(), testing::square_scene({testing::robots(1)}),
                                                   RunOptions{});
    EXPECT_FALSE(simulation->start());
    EXPECT_FALSE(testing::run_for(*simulation, seconds));
    return simulation;
}

TEST(Clock, SixtyHertzGives62AndAHalfTicksASecond) {
    EXPECT_NEAR(run_one(nullptr, nullptr, 1.0)->controllers().ticks(0), 63, 1);
    EXPECT_NEAR(run_one(nullptr, nullptr, 48.5)->controllers().ticks(0), 3031, 2);
}

TEST(Clock, SleepIsCutToWholeMilliseconds) {
    struct Case {
        uint8_t hz;
        double period_s;
    };
    static uint8_t hz = 0;
    for (Case const& c : {Case{10, 0.1}, Case{30, 0.033}, Case{40, 0.025}, Case{90, 0.011}}) {
        hz = c.hz;
        auto const simulation = run_one([] { main_loop_hz = hz; }, nullptr, 20.0);
        EXPECT_NEAR(simulation->controllers().ticks(0), 20.0 / c.period_s, 1.5) << int{c.hz} << " Hz";
    }
}

TEST(Clock, ZeroHertzTicksAtEachStep) {
    static int32_t elapsed_us = 0;
    auto const step = [] { elapsed_us = pogobot_stopwatch_get_elapsed_microseconds(&_global_timer); };
    EXPECT_EQ(run_one([] { main_loop_hz = 0; }, step, 1.0)->controllers().ticks(0), 100U);
    EXPECT_EQ(elapsed_us, 990000);
}

TEST(Clock, TimeStepIsLoweredWhenARobotTicksFaster) {
    testing::use_program([] { main_loop_hz = 200; }, nullptr);
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(1)}), {});
    ASSERT_FALSE(simulation.start());
    EXPECT_DOUBLE_EQ(simulation.world().time_step_s, 0.005);
}

TEST(Clock, SleepingRobotMissesItsTicks) {
    auto const step = [] {
        if (pogobot_ticks == 10) {
            msleep(500);
        }
    };
    EXPECT_NEAR(run_one(nullptr, step, 1.0)->controllers().ticks(0), 62 - 30, 1);
}

TEST(Clock, LateTickIsReportedOnTheErrorLedForASecond) {
    static std::vector<Leds> leds;
    leds.clear();
    testing::use_program(nullptr, [] {
        if (pogobot_ticks == 10) {
            msleep(100);
        }
    });
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(1)}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 0.5));
    EXPECT_EQ(simulation.world().robots.led[0][3], (Rgb{25, 0, 0}));
    ASSERT_FALSE(testing::run_for(simulation, 1.0));
    EXPECT_EQ(simulation.world().robots.led[0][3], (Rgb{0, 0, 0}));
}

TEST(Clock, StopwatchAndTimerFollowSleepWithinATick) {
    static std::vector<int32_t> seen;
    seen.clear();
    run_one(
        [] {
            time_reference_t watch;
            time_reference_t timer;
            pogobot_stopwatch_reset(&watch);
            pogobot_timer_init(&timer, 50000);
            msleep(20);
            seen.push_back(pogobot_stopwatch_get_elapsed_microseconds(&watch));  // 20000
            seen.push_back(pogobot_stopwatch_get_elapsed_microseconds(&watch));  // the same: no side effect
            seen.push_back(pogobot_timer_get_remaining_microseconds(&timer));    // 30000
            seen.push_back(pogobot_timer_has_expired(&timer));                   // 0
            pogobot_stopwatch_offset_origin_microseconds(&watch, 5000);
            seen.push_back(pogobot_stopwatch_lap(&watch));                       // 15000
            seen.push_back(pogobot_stopwatch_get_elapsed_microseconds(&watch));  // 0
            pogobot_timer_wait_for_expiry(&timer);
            seen.push_back(pogobot_timer_get_remaining_microseconds(&timer));  // 0
            msleep(1);
            seen.push_back(pogobot_timer_has_expired(&timer));  // 1
            pogobot_timer_offset_origin_microseconds(&timer, 10000);
            seen.push_back(pogobot_timer_get_remaining_microseconds(&timer));  // 9000
            pogobot_stopwatch_offset_origin_microseconds(&watch, 1000000);
            seen.push_back(pogobot_stopwatch_get_elapsed_microseconds(&watch));  // 31000 - 1000000
        },
        nullptr, 0.0);
    EXPECT_EQ(seen, (std::vector<int32_t>{20000, 20000, 30000, 0, 15000, 0, 0, 1, 9000, -969000}));
}

TEST(Clock, LoopThatWaitsForATimerEnds) {
    static int32_t waited_us = 0;
    run_one(
        nullptr,
        [] {
            time_reference_t watch;
            time_reference_t timer;
            pogobot_stopwatch_reset(&watch);
            pogobot_timer_init(&timer, 100000);
            while (!pogobot_timer_has_expired(&timer)) {
            }
            waited_us = pogobot_stopwatch_get_elapsed_microseconds(&watch);
        },
        0.2);
    EXPECT_NEAR(waited_us, 100000, 20);
}

TEST(Clock, LookAtTheClockTakesTenMicrosecondsBeyondTheThousandthOfATick) {
    static std::vector<int32_t> after_look;  // time of the tick so far, by number of looks
    static int looks_before = 0;             // in the tick, and not noted
    auto const note_looks = [] {
        static std::vector<int32_t> noted;
        noted.assign(static_cast<std::size_t>(looks_before) + 1, 0);
        time_reference_t start;
        pogobot_stopwatch_reset(&start);
        for (int look = looks_before + 2; look <= 3000; ++look) {
            noted.push_back(pogobot_stopwatch_get_elapsed_microseconds(&start));
        }
        after_look = noted;
    };
    auto const expect_20_ms = [] {
        ASSERT_EQ(after_look.size(), 3000U);
        EXPECT_EQ(after_look[998], 0);
        EXPECT_EQ(after_look[999], 0);
        EXPECT_EQ(after_look[1000], 10);
        EXPECT_EQ(after_look[1001], 20);
        EXPECT_EQ(after_look[2999], 20000);
    };
    looks_before = 0;
    run_one(note_looks, nullptr, 0.0);
    expect_20_ms();
    // Each tick anew; the main loop itself has looked once.
    looks_before = 1;
    run_one(nullptr, note_looks, 0.04);  // one of them is over
    expect_20_ms();
}

TEST(Clock, MillisecondsCountFromTheRobotsStart) {
    static uint32_t milliseconds = 0;
    run_one(
        nullptr, [] { milliseconds = current_time_milliseconds(); }, 10.0);
    EXPECT_NEAR(milliseconds, 9990, 16);
}

TEST(Clock, DriftMakesClocksDiffer) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->clock_drift_stddev_us = 500.0F;
    testing::use_program(nullptr, nullptr);
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(30, spec)}, 2000.0), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 20.0));
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < 30; ++i) {
        double const drift_us = 20e6 / simulation.controllers().ticks(i) - 16000.0;
        sum += drift_us / 30.0;
        squares += drift_us * drift_us / 30.0;
    }
    EXPECT_NEAR(sum, 0.0, 400.0);
    EXPECT_NEAR(std::sqrt(squares), 500.0, 250.0);
}

TEST(Clock, DriftTakesHalfOfATickAtMost) {
    static std::vector<int32_t> fastest_us;
    fastest_us.assign(30, std::numeric_limits<int32_t>::max());
    ObjectSpec spec = testing::article_robot();
    spec.robot->clock_drift_stddev_us = 50000.0F;  // most robots' drift is more than a tick
    testing::use_program([] { pogobot_stopwatch_reset(reinterpret_cast<time_reference_t*>(mydata)); },
                         [] {
                             auto* const since_last = reinterpret_cast<time_reference_t*>(mydata);
                             int32_t const tick_us = pogobot_stopwatch_lap(since_last);
                             if (pogobot_ticks > 0) {
                                 int32_t& fastest = fastest_us[pogobot_helper_getid()];
                                 fastest = std::min(fastest, tick_us);
                             }
                         });
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(30, spec)}, 2000.0), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 2.0));
    // Ticks of 16 ms, of which a drifting clock takes off 8 at most.
    EXPECT_EQ(std::ranges::min(fastest_us), 8000);
    EXPECT_GT(std::ranges::count(fastest_us, 8000), 5);
    EXPECT_GT(std::ranges::max(fastest_us), 16000);
}

}  // namespace
}  // namespace pogosim
