// Ends a test program whose test does not end. Linked into each of them, so that no test waits without a limit, even if
// the program is started by hand and not by CTest.
//
// The timer sends a real-time signal, since the code under test uses those that others would take (SIGALRM, SIGPROF).
// macOS has neither such timers nor such signals; there, CTest's limit is the only one.
#include "support/time_limit.hpp"

#ifdef __linux__

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <ctime>
#include <string>

namespace pogosim::testing {

namespace {

std::string message;  // made before the signal can come

void on_limit(int) {
    [[maybe_unused]] auto const written = write(STDERR_FILENO, message.data(), message.size());
    _exit(1);
}

class LimitOfEachTest : public ::testing::EmptyTestEventListener {
    void OnTestStart(::testing::TestInfo const& test) override {
        limit_time(std::string(test.test_suite_name()) + "." + test.name(), kLongestTestS);
    }
    void OnTestEnd(::testing::TestInfo const&) override { limit_time("", 0); }
};

[[maybe_unused]] bool const is_listening = [] {
    ::testing::UnitTest::GetInstance()->listeners().Append(new LimitOfEachTest);
    return true;
}();

}  // namespace

void limit_time(std::string const& what, int seconds) {
    static timer_t const timer = [] {
        struct sigaction action {};
        action.sa_handler = on_limit;
        sigaction(SIGRTMAX, &action, nullptr);
        sigevent event{};
        event.sigev_notify = SIGEV_SIGNAL;
        event.sigev_signo = SIGRTMAX;
        timer_t made{};
        timer_create(CLOCK_MONOTONIC, &event, &made);
        return made;
    }();
    itimerspec const none{};
    timer_settime(timer, 0, &none, nullptr);
    message = what + " did not end within " + std::to_string(seconds) + " s\n";
    itimerspec limit{};
    limit.it_value.tv_sec = seconds;
    timer_settime(timer, 0, &limit, nullptr);
}

}  // namespace pogosim::testing

#endif
