#include "base/log.hpp"

#include <gtest/gtest.h>

namespace pogosim {

namespace {

LogOptions plain() {
    LogOptions options;
    options.minimal = true;
    return options;
}

}  // namespace

TEST(Log, MessageThatQuotesSeveralLinesIsOneLine) {
    start_logging(plain());
    ::testing::internal::CaptureStderr();
    log().warn("category '{}'", "a\nb\x1b[31m");
    flush_logs();
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "category 'a\\nb\\x1b[31m'\n");
}

TEST(Log, LinesOfRobotsComeAsTheyAre) {
    start_logging(plain());
    ::testing::internal::CaptureStdout();
    robot_log().info("{}", "a\tb\x1b[31m");
    flush_logs();
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "a\tb\x1b[31m\n");
}

}  // namespace pogosim
