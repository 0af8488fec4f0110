#include "support/time_limit.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

namespace pogosim::testing {

#ifdef __linux__

// A child that is forked has no timer of its parent's, so the death test sets one of its own.
TEST(TimeLimit, TestThatDoesNotEndIsEndedWithItsName) {
    auto const wait_for_ever = [] {
        limit_time("Swarm.NeverEnds", 1);
        for (int i = 0; i < 600; ++i) {
            sleep(1);
        }
    };
    ::testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(wait_for_ever(), ::testing::ExitedWithCode(1), "Swarm.NeverEnds did not end within 1 s");
}

#endif

}  // namespace pogosim::testing
