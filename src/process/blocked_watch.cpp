#include "process/crash_handler_state.hpp"

#ifdef __linux__

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "base/background_thread.hpp"
#include "process/backtrace.hpp"
#include "process/crash_message.hpp"
#include "process/signals_of_runs.hpp"

namespace pogosim {

namespace {

constexpr std::chrono::milliseconds kLookPeriod{250};
constexpr int kBlockedLooks = 8;  // 2 s, counted in looks so that time in which this process is stopped does not count
constexpr int kForgottenLooks = 2;  // per look that finds it awake, as a busy machine does now and then: see look()
constexpr int kLongLooks = 2;       // a call that lasts until the second one is watched over, see start_watch()
constexpr int kIdleLooks = 40;      // 10 s without a run, after which the thread of the watch ends

/// The system call in which a thread waits.
struct SystemCall {
    long number = -1;
    std::uintptr_t stack_pointer = 0;
    std::uintptr_t program_counter = 0;
};

std::string content_of(pid_t thread, char const* file) {
    std::array<char, 64> path{};
    std::snprintf(path.data(), path.size(), "/proc/self/task/%d/%s", static_cast<int>(thread), file);
    std::array<char, 512> text{};
    int const descriptor = open(path.data(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return "";
    }
    ssize_t const bytes = read(descriptor, text.data(), text.size());
    close(descriptor);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, bytes))};
}

/// Whether the kernel reports the thread as sleeping: not stopped (by a debugger, say), nor waiting for a disk or a
/// processor.
bool is_sleeping(pid_t thread) {
    std::string const stat = content_of(thread, "stat");
    std::size_t const end_of_name = stat.rfind(") ");
    return end_of_name != std::string::npos && stat.compare(end_of_name + 2, 1, "S") == 0;
}

std::optional<SystemCall> system_call_of(pid_t thread) {
    // "number argument ... argument stack-pointer program-counter", or "running".
    std::string const text = content_of(thread, "syscall");
    std::size_t const before_counter = text.rfind(' ');
    if (before_counter == std::string::npos || before_counter == 0) {
        return std::nullopt;
    }
    std::size_t const before_pointer = text.rfind(' ', before_counter - 1);
    if (before_pointer == std::string::npos) {
        return std::nullopt;
    }
    constexpr int base = 16;
    return SystemCall{.number = std::atol(text.c_str()),
                      .stack_pointer = std::strtoull(text.c_str() + before_pointer + 1, nullptr, base),
                      .program_counter = std::strtoull(text.c_str() + before_counter + 1, nullptr, base)};
}

/// Writing may block because the reader of the output is slow.
bool writes(SystemCall const& call) {
    constexpr std::array<long, 5> writing{SYS_write, SYS_writev, SYS_pwrite64, SYS_fsync, SYS_fdatasync};
    return std::ranges::find(writing, call.number) != writing.end();
}

class BlockedWatch {
public:
    /// Returns whether there is a thread that looks.
    bool begin(CrashHandlerState& handler) {
        std::lock_guard const lock(mutex_);
        ++begun_;
        watched_.push_back({.handler = &handler});
        if (!has_thread_) {
            has_thread_ = true;
            try {
                start_background_thread("watching over blocked calls", [this] { serve(); }).detach();
            } catch (std::system_error const&) {  // without the thread, there are no warnings
                has_thread_ = false;
            }
        }
        return has_thread_;
    }

    void end(CrashHandlerState& handler) {
        std::lock_guard const lock(mutex_);
        std::erase_if(watched_, [&](Watched const& watched) { return watched.handler == &handler; });
    }

    bool has_thread() {
        std::lock_guard const lock(mutex_);
        return has_thread_;
    }

private:
    struct Watched {
        CrashHandlerState* handler = nullptr;
        int looks = 0;
        unsigned long calls = 0;  // of user code, when it was first found asleep
        int blocked_looks = 0;    // that found it asleep, in one call or in many short ones; fewer when it was awake
    };

    void serve() {
        std::unique_lock lock(mutex_);
        for (int looks_in_vain = 0; looks_in_vain <= kIdleLooks;) {
            unsigned long const begun = begun_;
            lock.unlock();
            std::this_thread::sleep_for(kLookPeriod);
            let_go_of_signals();
            lock.lock();
            looks_in_vain = watched_.empty() && begun == begun_ ? looks_in_vain + 1 : 0;
            for (Watched& watched : watched_) {
                look(watched);
            }
        }
        has_thread_ = false;
    }

    /// Code that blocks more than two thirds of its time is told in the end, whatever else the machine does.
    static void look(Watched& watched) {
        CrashHandlerState const& handler = *watched.handler;
        if (++watched.looks == kLongLooks) {
            arm_watch(*watched.handler);
        }
        unsigned long const calls = handler.calls.load(std::memory_order_acquire);
        CrashHandlerState& run = handler.helped != nullptr ? *handler.helped : *watched.handler;
        if (run.is_told_of_blocked) {
            return;
        }
        bool const sleeps = handler.inside && is_sleeping(handler.thread_id);
        std::optional<SystemCall> const call = sleeps ? system_call_of(handler.thread_id) : std::nullopt;
        if (!call || writes(*call)) {
            watched.blocked_looks = std::max(0, watched.blocked_looks - kForgottenLooks);
            return;
        }
        if (watched.blocked_looks++ == 0) {
            watched.calls = calls;
        }
        if (watched.blocked_looks >= kBlockedLooks) {
            char const* const how = calls == watched.calls
                                        ? "has blocked for 2 s of wall-clock time"
                                        : "blocks again and again: for 2 s of wall-clock time by now";
            run.is_told_of_blocked = tell(handler, *call, calls, how);
        }
    }

    /// The watched thread may continue meanwhile, but its run cannot end before this returns (mutex_). False if the
    /// call has returned by now.
    static bool tell(CrashHandlerState const& handler, SystemCall const& call, unsigned long calls, char const* how) {
        void const* const place =
            place_in_stack({call.stack_pointer, call.program_counter, handler.thread_id}, handler.program_base);
        std::string const where = handler.running.place_of(handler.thread_of_code, place, [&] {
            return handler.inside && handler.calls.load(std::memory_order_acquire) == calls;
        });
        if (where.empty()) {
            return false;
        }
        SignalText<1024> text;
        text << "pogosim: warning: " << where.c_str() << ", " << how
             << ", and the run with it. Robots wait in simulated time, "
                "with msleep(), usleep() or sleep() (docs/porting.md)\n";
        text.write_to_stderr();
        return true;
    }

    std::mutex mutex_;
    std::vector<Watched> watched_;
    unsigned long begun_ = 0;  // runs, or their steps, that were watched: after each the thread stays for a while
    bool has_thread_ = false;
};

/// Never destroyed, since its thread may outlive the last run.
std::atomic<BlockedWatch*> watch_of_process = nullptr;

/// The id of this thread; 0: not asked yet.
constinit thread_local pid_t this_thread_id = 0;

}  // namespace

void forget_blocked_in_child() {
    watch_of_process = nullptr;  // its thread is not there
    this_thread_id = 0;
}

bool watch_over_blocked(CrashHandlerState& handler) {
    static std::mutex making;
    if (this_thread_id == 0) {
        this_thread_id = static_cast<pid_t>(syscall(SYS_gettid));
    }
    handler.thread_id = this_thread_id;
    handler.thread_of_code = handler.running.of_this_thread();
    BlockedWatch* watch = watch_of_process;
    if (watch == nullptr) {
        std::lock_guard const lock(making);
        watch = watch_of_process;
        if (watch == nullptr) {
            watch = new BlockedWatch;
            watch_of_process = watch;
        }
    }
    return watch->begin(handler);
}

bool watches_over_blocked() {
    BlockedWatch* const watch = watch_of_process;
    return watch != nullptr && watch->has_thread();
}

void end_watch_over_blocked(CrashHandlerState& handler) {
    BlockedWatch* const watch = watch_of_process;
    if (watch != nullptr) {
        watch->end(handler);
    }
}

}  // namespace pogosim

#else

namespace pogosim {

bool watch_over_blocked(CrashHandlerState& /*handler*/) {
    return false;
}
void end_watch_over_blocked(CrashHandlerState& /*handler*/) {}
bool watches_over_blocked() {
    return false;
}
void forget_blocked_in_child() {}

}  // namespace pogosim

#endif
