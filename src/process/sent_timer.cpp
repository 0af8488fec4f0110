#include "process/sent_timer.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#ifdef __APPLE__
#include <mach/mach.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <mutex>
#include <system_error>
#include <vector>

#include "base/background_thread.hpp"
#include "process/sent_signals.hpp"

namespace pogosim {

namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;
constexpr std::int64_t kNsPerMs = 1'000'000;
// A thread that sleeps just before its time is looked at again after this part of the period.
constexpr std::int64_t kLooksPerPeriod = 4;

[[maybe_unused]] std::int64_t read_clock_ns(clockid_t clock) {
    timespec now = {};
    clock_gettime(clock, &now);
    return now.tv_sec * kNsPerS + now.tv_nsec;
}

/// For how long a thread has used a processor.
std::int64_t processor_time_ns(pthread_t thread) {
#ifdef __APPLE__
    thread_basic_info info = {};
    mach_msg_type_number_t count = THREAD_BASIC_INFO_COUNT;
    if (thread_info(pthread_mach_thread_np(thread), THREAD_BASIC_INFO, reinterpret_cast<thread_info_t>(&info),
                    &count) != KERN_SUCCESS) {
        return 0;
    }
    constexpr std::int64_t ns_per_us = 1000;
    auto const ns = [](time_value_t const& time) { return time.seconds * kNsPerS + time.microseconds * ns_per_us; };
    return ns(info.user_time) + ns(info.system_time);
#else
    clockid_t clock{};
    return pthread_getcpuclockid(thread, &clock) == 0 ? read_clock_ns(clock) : 0;
#endif
}

}  // namespace

struct SentTimer::Entry {
    SignalledThread thread = SignalledThread::current();
    TimerClock clock;
    int signal;
    // Written by start() and stop().
    std::atomic<std::int64_t> period_ns = 0;  // 0: it is stopped
    std::atomic<unsigned> starts = 0;
    // The thread that looks has these for itself.
    unsigned starts_seen = 0;
    std::int64_t due_ns = 0;

    std::int64_t now_ns() const {
        return clock == TimerClock::wall ? read_clock_ns(CLOCK_MONOTONIC) : processor_time_ns(thread.id());
    }

    /// Sends the signal if it is due. Returns how long to wait until the next look; negative: it is stopped.
    std::int64_t look() {
        unsigned const begun = starts;
        std::int64_t const period = period_ns;
        if (period == 0) {
            return -1;
        }
        std::int64_t const now = now_ns();
        if (begun != starts_seen) {
            starts_seen = begun;
            due_ns = now + period;
        } else if (now >= due_ns) {
            due_ns = now + period;
            thread.send(signal);
        }
        // No thread uses more processor time than time passes.
        return clock == TimerClock::wall ? due_ns - now : std::max(due_ns - now, period / kLooksPerPeriod);
    }
};

namespace {

/// Its thread lives as long as the process, and sleeps while no timer runs.
class Sender {
public:
    explicit Sender(std::array<int, 2> const& ends) : ends_(ends) {}

    bool is_of_this_process() const { return process_ == getpid(); }

    void begin(std::shared_ptr<SentTimer::Entry> entry) {
        std::lock_guard const lock(mutex_);
        entries_.push_back(std::move(entry));
    }

    void end(SentTimer::Entry const* entry) {
        std::lock_guard const lock(mutex_);
        std::erase_if(entries_, [entry](auto const& one) { return one.get() == entry; });
    }

    /// For signal handlers, too.
    void wake() const {
        int const error_before = errno;  // that of the code which a handler interrupts
        char const any = 0;
        [[maybe_unused]] ssize_t const ignored = write(ends_[1], &any, sizeof(any));  // full: it will wake up anyway
        errno = error_before;
    }

    void serve() {
        for (;;) {
            pollfd woken{.fd = ends_[0], .events = POLLIN, .revents = 0};
            poll(&woken, 1, wait_ms());
            std::array<char, 64> any{};
            while (read(ends_[0], any.data(), any.size()) > 0) {
            }
        }
    }

private:
    int wait_ms() {
        std::lock_guard const lock(mutex_);
        std::int64_t next_ns = -1;
        for (auto const& entry : entries_) {
            if (std::int64_t const wait_ns = entry->look(); wait_ns >= 0) {
                next_ns = next_ns < 0 ? wait_ns : std::min(next_ns, wait_ns);
            }
        }
        constexpr std::int64_t longest_ms = 60'000;
        return next_ns < 0 ? -1 : static_cast<int>(std::min(longest_ms, (next_ns + kNsPerMs - 1) / kNsPerMs));
    }

    pid_t process_ = getpid();
    std::array<int, 2> ends_;
    std::mutex mutex_;
    std::vector<std::shared_ptr<SentTimer::Entry>> entries_;
};

std::atomic<Sender*> sender_of_process = nullptr;

/// Null: the system has no thread or no file left, and nothing is watched over.
Sender* sender() {
    Sender* now = sender_of_process;
    if (now != nullptr && now->is_of_this_process()) {
        return now;
    }
    static std::mutex making;
    std::lock_guard const lock(making);
    now = sender_of_process;
    if (now != nullptr && now->is_of_this_process()) {
        return now;
    }
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) {
        return nullptr;
    }
    for (int const end : ends) {
        fcntl(end, F_SETFD, FD_CLOEXEC);
        fcntl(end, F_SETFL, O_NONBLOCK);
    }
    auto* const made = new Sender(ends);  // never destroyed, since its thread goes on
    try {
        start_background_thread("watching over user code", [made] { made->serve(); }).detach();
    } catch (std::system_error const&) {
        close(ends[0]);
        close(ends[1]);
        delete made;
        return nullptr;
    }
    sender_of_process = made;
    return made;
}

void wake_sender() {
    Sender const* const now = sender_of_process;
    if (now != nullptr && now->is_of_this_process()) {
        now->wake();
    }
}

}  // namespace

SentTimer::SentTimer(TimerClock clock, int signal) : entry_(new Entry{.clock = clock, .signal = signal}) {
    if (Sender* const now = sender()) {
        now->begin(entry_);
    }
}

SentTimer::~SentTimer() {
    Sender* const now = sender_of_process;
    if (now != nullptr && now->is_of_this_process()) {
        now->end(entry_.get());
    }
}

void SentTimer::start(double period_s) {
    entry_->period_ns = std::max<std::int64_t>(1, std::llround(period_s * static_cast<double>(kNsPerS)));
    ++entry_->starts;
    wake_sender();
}

void SentTimer::stop() {
    entry_->period_ns = 0;
}

}  // namespace pogosim
