// The watch over user code, and what a process looks like to its other users while a run goes on, and after it.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
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

std::atomic<std::size_t> calls_of_other_handler = 0;

void other_handler(int /*signal*/) {
    ++calls_of_other_handler;
}

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

/// Within so long, or not at all.
bool comes_true(std::function<bool()> const& what) {
    constexpr std::chrono::seconds longest{30};
    auto const begin = std::chrono::steady_clock::now();
    while (!what()) {
        if (std::chrono::steady_clock::now() - begin > longest) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

TEST(Watchdog, GivesBackTheSignalsOfTheProcess) {
    constexpr std::array kSignals{SIGSEGV, SIGFPE, SIGABRT, SIGPROF, SIGALRM};
    for (int const signal : kSignals) {
        std::signal(signal, other_handler);
    }
    calls_of_other_handler = 0;
    CrashHandler handler(kNoCode, nullptr, 3.0);
    {
        CrashHandlerScope const thread(handler);
        CrashHandlerScope const again(handler);
        for (int const signal : kSignals) {
            EXPECT_NE(handler_of(signal), other_handler);
        }
    }
    for (int const signal : kSignals) {
        std::raise(signal);  // it is passed on until then
    }
    EXPECT_EQ(calls_of_other_handler, kSignals.size());
    for (int const signal : kSignals) {
        EXPECT_TRUE(comes_true([&] { return handler_of(signal) == other_handler; }));
        std::signal(signal, SIG_DFL);
    }
}

Handler handler_before = nullptr;

/// As faulthandler of Python: leaves a crash to the handler that it found.
void handler_that_passes_on(int signal) {
    ++calls_of_other_handler;
    std::signal(signal, handler_before);
    std::raise(signal);
}

TEST(Watchdog, CrashOfTheProcessEndsItThoughItsHandlerLeavesThatToOurs) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    auto const die = [] {
        CrashHandler handler(kNoCode, nullptr, 3.0);
        { CrashHandlerScope const thread(handler); }
        handler_before = std::signal(SIGSEGV, handler_that_passes_on);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        { CrashHandlerScope const thread(handler); }  // finds that handler
        std::raise(SIGSEGV);
    };
    EXPECT_EXIT(die(), ::testing::KilledBySignal(SIGSEGV), "");
}

TEST(Watchdog, HandlersOfTheProcessFromBetweenTwoRunsAreKept) {
    CrashHandler handler(kNoCode, nullptr, 3.0);
    { CrashHandlerScope const thread(handler); }
    std::signal(SIGFPE, other_handler);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    {
        CrashHandlerScope const thread(handler);
        auto const failure = call_user_code([] { std::raise(SIGFPE); });
        ASSERT_TRUE(failure);
        EXPECT_NE(failure->what.find("arithmetic error"), std::string::npos) << failure->what;
    }
    EXPECT_TRUE(comes_true([] { return handler_of(SIGFPE) == other_handler; }));
    std::signal(SIGFPE, SIG_DFL);
}

TEST(Watchdog, EndsWhatDoesNotReturnWithinALongerTimeToo) {
    CrashHandler handler(kNoCode, nullptr, 1.0);
    { CrashHandlerScope const thread(handler); }  // now there is a thread that looks
    CrashHandlerScope const thread(handler);
    std::signal(SIGPROF, other_handler);  // too late for the scope to see
    auto const failure = call_user_code([] {
        for (std::atomic<bool> ever = true; ever;) {
        }
    });
    ASSERT_TRUE(failure);
    EXPECT_TRUE(failure->too_long);
    std::signal(SIGPROF, SIG_DFL);
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
