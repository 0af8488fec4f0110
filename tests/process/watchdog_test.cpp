// The watch over user code, and what a process looks like to its other users while a run goes on, and after it.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "process/crash_handler.hpp"

namespace pogosim {
namespace {

using Handler = void (*)(int);

Handler handler_of(int signal) {
    struct sigaction now = {};
    sigaction(signal, nullptr, &now);
    return now.sa_handler;
}

void other_handler(int /*signal*/) {}

class NoCode : public RunningCode {
public:
    bool is_known() const override { return false; }
    PlaceText stage() const override { return {}; }
    PlaceText place() const override { return {}; }
    SignalText<256> how_to_repeat() const override { return {}; }
    bool is_at_start() const override { return false; }
    void const* of_this_thread() const override { return nullptr; }
    std::string place_of(void const* /*thread*/, void const* /*code*/,
                         std::function<bool()> const& /*is_there*/) const override {
        return "";
    }
};
NoCode const kNoCode;

TEST(Watchdog, GivesBackTheSignalsOfTheProcess) {
    constexpr std::array kSignals{SIGSEGV, SIGFPE, SIGABRT, SIGPROF, SIGALRM};
    for (int const signal : kSignals) {
        std::signal(signal, other_handler);
    }
    CrashHandler handler(kNoCode, nullptr, 3.0);
    {
        CrashHandlerScope const thread(handler);
        CrashHandlerScope const again(handler);
        for (int const signal : kSignals) {
            EXPECT_NE(handler_of(signal), other_handler);
        }
    }
    for (int const signal : kSignals) {
        EXPECT_EQ(handler_of(signal), other_handler);
        std::signal(signal, SIG_DFL);
    }
}

/// The signal would find no handler.
TEST(Watchdog, SendsNoSignalForARequestThatComesAfterTheRun) {
    std::signal(SIGALRM, [](int) { std::abort(); });
    CrashHandler handler(kNoCode, nullptr, 0.0);
    { CrashHandlerScope const thread(handler); }
    handler.hurry("the test");
    std::thread([&] { handler.hurry("the test"); }).join();
    std::signal(SIGALRM, SIG_DFL);
}

TEST(Watchdog, EndsWhatDoesNotReturnAndNothingElse) {
    CrashHandler handler(kNoCode, nullptr, 0.05);
    CrashHandlerScope const thread(handler);
    EXPECT_FALSE(call_user_code([] {}));
    auto const failure = call_user_code([] {
        for (std::atomic<bool> ever = true; ever;) {
        }
    });
    ASSERT_TRUE(failure);
    EXPECT_TRUE(failure->too_long);
    EXPECT_TRUE(handler.was_left_by_force());
}

/// Each run has a thread, and each thread a run: a failure is that of the run in which it happens.
TEST(Watchdog, FailuresInTwoThreadsAreThoseOfTheirRuns) {
    auto const spin = [](std::optional<UserFailure>& failure) {
        CrashHandler handler(kNoCode, nullptr, 0.1);
        CrashHandlerScope const thread(handler);
        failure = call_user_code([] {
            for (std::atomic<bool> ever = true; ever;) {
            }
        });
    };
    auto const crash = [](std::optional<UserFailure>& failure) {
        CrashHandler handler(kNoCode, nullptr, 10.0);
        CrashHandlerScope const thread(handler);
        failure = call_user_code([] { std::raise(SIGSEGV); });
    };
    std::optional<UserFailure> slow;
    std::optional<UserFailure> crashed;
    std::thread one(spin, std::ref(slow));
    std::thread other(crash, std::ref(crashed));
    one.join();
    other.join();
    ASSERT_TRUE(slow && crashed);
    EXPECT_TRUE(slow->too_long);
    EXPECT_FALSE(crashed->too_long);
    EXPECT_NE(crashed->what.find("segmentation fault"), std::string::npos);
}

}  // namespace
}  // namespace pogosim
