// The timers that stand for those of the system on macOS. They work on Linux as well.
#include "process/sent_timer.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include "process/sent_signals.hpp"

namespace pogosim {
namespace {

constexpr double kPeriodS = 0.002;

thread_local std::atomic<int> sent_here = 0;
std::atomic<int> of_others = 0;

void on_signal(int signal) {
    ++(take_sent_signal(signal) ? sent_here : of_others);
}

class SentTimerTest : public testing::Test {
protected:
    SentTimerTest() {
        sent_here = 0;
        of_others = 0;
        struct sigaction action = {};
        action.sa_handler = on_signal;
        action.sa_flags = SA_RESTART;
        sigaction(SIGALRM, &action, &alarm_before_);
        sigaction(SIGPROF, &action, &profile_before_);
    }
    ~SentTimerTest() override {
        sigaction(SIGALRM, &alarm_before_, nullptr);
        sigaction(SIGPROF, &profile_before_, nullptr);
    }
    SentTimerTest(SentTimerTest const&) = delete;
    SentTimerTest& operator=(SentTimerTest const&) = delete;

private:
    struct sigaction alarm_before_ = {};
    struct sigaction profile_before_ = {};
};

/// Within so long, or not at all.
void compute_until(int signals) {
    constexpr std::chrono::seconds longest{60};
    auto const begin = std::chrono::steady_clock::now();
    while (sent_here < signals && std::chrono::steady_clock::now() - begin < longest) {
    }
}

TEST_F(SentTimerTest, AThreadThatComputesGetsSignalsOfItsProcessorTime) {
    SentTimer timer(TimerClock::processor, SIGPROF);
    timer.start(kPeriodS);
    compute_until(3);
    EXPECT_GE(sent_here, 3);
    EXPECT_EQ(of_others, 0);
}

TEST_F(SentTimerTest, AThreadThatSleepsGetsNoneOfItsProcessorTime) {
    SentTimer timer(TimerClock::processor, SIGPROF);
    timer.start(/*period_s=*/0.1);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_EQ(sent_here, 0);
}

TEST_F(SentTimerTest, WallClockTimePassesInSleep) {
    SentTimer timer(TimerClock::wall, SIGALRM);
    timer.start(kPeriodS);
    for (int i = 0; i < 6000 && sent_here < 3; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_GE(sent_here, 3);
}

TEST_F(SentTimerTest, AStoppedTimerSendsNoMoreThanTheSignalThatIsOnItsWay) {
    SentTimer timer(TimerClock::wall, SIGALRM);
    timer.start(kPeriodS);
    compute_until(1);
    timer.stop();
    int const before = sent_here;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_LE(sent_here, before + 1);
}

TEST_F(SentTimerTest, SignalsOfATimerThatIsGoneAreStillKnown) {
    for (int i = 0; i < 200; ++i) {
        std::optional<SentTimer> timer(std::in_place, TimerClock::processor, SIGPROF);
        timer->start(/*period_s=*/0.0001);
        compute_until(i + 1);
        timer.reset();
    }
    EXPECT_EQ(of_others, 0);
}

TEST_F(SentTimerTest, EachThreadHasItsOwn) {
    SentTimer timer(TimerClock::processor, SIGPROF);
    std::atomic<int> there = -1;
    std::thread other([&there] {
        SentTimer own(TimerClock::processor, SIGPROF);
        own.start(kPeriodS);
        compute_until(2);
        there = sent_here.load();
    });
    other.join();
    EXPECT_GE(there, 2);
    EXPECT_EQ(sent_here, 0) << "this thread's timer was not started";
    timer.start(kPeriodS);
    compute_until(2);
    EXPECT_GE(sent_here, 2);
}

TEST_F(SentTimerTest, AChildOfForkHasNoTimersOfItsParentAndMayMakeItsOwn) {
    SentTimer timer(TimerClock::processor, SIGPROF);
    timer.start(kPeriodS);
    compute_until(1);
    pid_t const child = fork();
    if (child == 0) {
        int const before = sent_here;
        SentTimer own(TimerClock::wall, SIGALRM);
        own.start(kPeriodS);
        compute_until(before + 1);
        _exit(sent_here > before && of_others == 0 ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
}

TEST_F(SentTimerTest, AThreadDoesNotTakeSignalsOfAnEarlierOneThatHadTheSameId) {
    std::thread([] {
        sigset_t alarm;
        sigemptyset(&alarm);
        sigaddset(&alarm, SIGALRM);
        pthread_sigmask(SIG_BLOCK, &alarm, nullptr);
        SignalledThread::current().send(SIGALRM);
    }).join();
    std::thread([] {
        SignalledThread::current();
        std::raise(SIGALRM);
    }).join();
    EXPECT_EQ(of_others, 1);
}

TEST_F(SentTimerTest, AThreadThatIsSentNoSignalsTakesNone) {
    std::thread([] { std::raise(SIGALRM); }).join();
    EXPECT_EQ(of_others, 1);
}

TEST_F(SentTimerTest, AnAlarmOfTheProgramIsNoSentSignal) {
    // In a thread of its own: in this one, two signals of an earlier test may have merged.
    std::thread([] {
        SentTimer timer(TimerClock::wall, SIGALRM);
        timer.start(/*period_s=*/1000.0);
        std::raise(SIGALRM);
        EXPECT_EQ(sent_here, 0);
    }).join();
    EXPECT_EQ(of_others, 1);
}

}  // namespace
}  // namespace pogosim
