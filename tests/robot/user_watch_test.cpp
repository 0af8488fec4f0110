// The watch over user code, and its timers.
#include <gtest/gtest.h>
#include <sys/time.h>

#include <thread>

#include "robot/user_guard.hpp"

namespace pogosim {
namespace {

bool is_timer_running() {
    itimerval timer = {};
    getitimer(ITIMER_REAL, &timer);
    return timer.it_interval.tv_usec != 0;
}

TEST(UserWatch, LooksAtTheClockFromARequestToStopUntilTheEndOfTheRun) {
    install_user_guard(0.0);
    EXPECT_FALSE(is_timer_running());
    hurry_user_code("the test");
    EXPECT_TRUE(is_timer_running());
    remove_user_guard();
    EXPECT_FALSE(is_timer_running());
}

/// A timer that nobody stops would end the program that takes the place of this one.
TEST(UserWatch, StartsNoTimerForARequestThatComesAfterTheRun) {
    install_user_guard(0.0);
    remove_user_guard();
    hurry_user_code("the test");
    EXPECT_FALSE(is_timer_running());
    std::thread([] { hurry_user_code_from_thread("the test"); }).join();
    EXPECT_FALSE(is_timer_running());
}

}  // namespace
}  // namespace pogosim
