// Many runs on the threads of a host.
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "base/error.hpp"
#include "host/hosted_run.hpp"
#include "host/status.hpp"
#include "process/signals_of_runs.hpp"

using namespace pogosim;

namespace {

using Clock = std::chrono::steady_clock;
using Deadline = std::chrono::time_point<Clock, std::chrono::duration<double>>;  // may be infinitely far

constexpr int kMostHostThreads = 1024;

/// What one call asks for.
struct Work {
    std::span<pogosim_run* const> runs{};
    std::span<pogosim_turn> turns{};
    std::span<pogosim_exchange const> exchanges{};
    std::span<std::string> errors{};
    Deadline deadline{};
};

double seconds_until(Deadline when) {
    return std::chrono::duration<double>(when - Clock::now()).count();
}

/// Exchanges its arrays around the steps, while what they are made of is in the cache.
void make_turn(Work const& work, std::size_t index) {
    pogosim_run& run = *work.runs[index];
    pogosim_turn& turn = work.turns[index];
    if (turn.status != POGOSIM_OK) {
        turn.has_messages = 0;
        return;
    }
    std::lock_guard const lock(run.in_use);
    turn.status = with_status([&] {
        for (pogosim_exchange const& exchange : work.exchanges) {
            if (exchange.gives != 0) {
                give_array(run, index, exchange);
            }
        }
        take_turn(run, turn, seconds_until(work.deadline));
        for (pogosim_exchange const& exchange : work.exchanges) {
            if (exchange.takes != 0) {
                take_array(run, index, exchange);
            }
        }
        return turn.status;
    });
    if (turn.status != POGOSIM_OK && turn.status != POGOSIM_OVER) {
        work.errors[index] = pogosim_host_error();
    }
}

}  // namespace

/// As declared in pogosim/host.h. The thread that calls step() works, too.
struct pogosim_threads {
public:
    explicit pogosim_threads(int count) {
        for (int i = 1; i < count; ++i) {
            try {
                threads_.emplace_back([this] { serve(); });
            } catch (std::system_error const&) {
                break;  // there are fewer
            }
        }
    }

    ~pogosim_threads() {
        {
            std::lock_guard const lock(mutex_);
            is_closed_ = true;
        }
        has_work_.notify_all();
        for (std::thread& thread : threads_) {
            thread.join();
        }
    }

    pogosim_threads(pogosim_threads const&) = delete;
    pogosim_threads& operator=(pogosim_threads const&) = delete;

    int step(std::span<pogosim_run* const> runs, std::span<pogosim_turn> turns,
             std::span<pogosim_exchange const> exchanges, double budget_s) {
        std::lock_guard const one_call(in_use_);
        errors_.assign(runs.size(), {});
        auto const deadline = Clock::now() + std::chrono::duration<double>(budget_s);
        {
            std::lock_guard const lock(mutex_);
            work_ = {.runs = runs, .turns = turns, .exchanges = exchanges, .errors = errors_, .deadline = deadline};
            next_ = 0;
            ++call_;
            working_ = static_cast<int>(threads_.size());
        }
        has_work_.notify_all();
        take_turns();
        std::unique_lock lock(mutex_);
        has_ended_.wait(lock, [this] { return working_ == 0; });
        for (std::size_t i = 0; i < runs.size(); ++i) {
            if (!errors_[i].empty()) {
                return failed(errors_[i], turns[i].status);
            }
        }
        return POGOSIM_OK;
    }

    char const* error(std::size_t run) const { return run < errors_.size() ? errors_[run].c_str() : ""; }

private:
    void take_turns() {
        ThreadOfRuns const thread;
        for (std::size_t i = next_++; i < work_.runs.size(); i = next_++) {
            make_turn(work_, i);
        }
    }

    void serve() {
        std::uint64_t seen = 0;
        std::unique_lock lock(mutex_);
        for (;;) {
            has_work_.wait(lock, [&] { return is_closed_ || call_ != seen; });
            if (is_closed_) {
                return;
            }
            seen = call_;
            lock.unlock();
            take_turns();
            lock.lock();
            if (--working_ == 0) {
                has_ended_.notify_one();
            }
        }
    }

    std::mutex in_use_;
    std::vector<std::thread> threads_;
    std::vector<std::string> errors_;

    std::mutex mutex_;  // protects what follows but the next index
    std::condition_variable has_work_;
    std::condition_variable has_ended_;
    Work work_;
    std::uint64_t call_ = 0;
    int working_ = 0;  // threads that may still work at this call
    bool is_closed_ = false;
    std::atomic<std::size_t> next_ = 0;  // run to take
};

int pogosim_threads_open(int count, pogosim_threads** threads) {
    *threads = nullptr;
    return with_status([&] {
        if (count < 1 || count > kMostHostThreads) {
            throw ConfigError(
                fmt::format("threads: expected a number from 1 to {}, found {}", kMostHostThreads, count));
        }
        *threads = std::make_unique<pogosim_threads>(count).release();
        return POGOSIM_OK;
    });
}

int pogosim_threads_step(pogosim_threads* threads, pogosim_run* const* runs, pogosim_turn* turns, size_t count,
                         pogosim_exchange const* exchanges, size_t exchange_count, double budget_s) {
    return with_status([&] {
        return threads->step({runs, count}, {turns, count}, {exchanges, exchange_count}, budget_s);
    });
}

char const* pogosim_threads_error(pogosim_threads const* threads, size_t run) {
    return threads->error(run);
}

void pogosim_threads_close(pogosim_threads* threads) {
    delete threads;
}
