#include "base/worker_pool.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "base/background_thread.hpp"

namespace pogosim {

namespace {

constexpr int kPartBits = 21;
constexpr std::uint64_t kPartMask = (std::uint64_t{1} << kPartBits) - 1;
// Number of checks before a thread goes to sleep: the phases of a step follow each other within microseconds.
constexpr int kPatience = 4000;
constexpr std::uint32_t kRangesPerWorker = 4;

std::uint64_t next_part(std::uint64_t ticket) {
    return ticket & kPartMask;
}
std::uint64_t parts_of(std::uint64_t ticket) {
    return ticket >> kPartBits & kPartMask;
}
std::uint64_t round_of(std::uint64_t ticket) {
    return ticket >> 2 * kPartBits;
}

/// Returns whether the condition became true within kSpins checks.
template <class Condition>
bool becomes_true(Condition const& condition) {
    for (int i = 0; i < kPatience; ++i) {
        if (condition()) {
            return true;
        }
#if defined(__x86_64__)
        __builtin_ia32_pause();
#elif defined(__aarch64__)
        asm volatile("yield");
#endif
    }
    return false;
}

}  // namespace

WorkerPool::WorkerPool(std::uint32_t size) {
    threads_.reserve(size - 1);
    for (std::uint32_t worker = 1; worker < size; ++worker) {
        try {
            threads_.push_back(start_background_thread("working on a step", [this, worker] { serve(worker); }));
        } catch (std::system_error const&) {
            return;  // fewer workers are enough
        }
    }
}

WorkerPool::~WorkerPool() {
    is_closed_ = true;
    wake_workers();
    for (std::thread& thread : threads_) {
        if (has_background_thread_crashed()) {
            thread.detach();  // it may be the one that crashed and never ends
        } else {
            thread.join();
        }
    }
}

std::uint32_t WorkerPool::range_count(std::uint32_t count, std::uint32_t least) const {
    if (size() == 1) {
        return 1;
    }
    return std::clamp(count / least, 1U, kRangesPerWorker * size());
}

void WorkerPool::share(std::uint32_t parts, void const* work, Call call) {
    work_ = work;
    call_ = call;
    done_ = 0;
    ticket_ = (round_of(ticket_) + 1) << 2 * kPartBits | std::uint64_t{parts} << kPartBits;
    wake_workers();
    while (take_part(0)) {
    }
    wait_for_end(parts);
    if (exception_) {
        std::rethrow_exception(std::exchange(exception_, nullptr));
    }
}

/// Returns whether a part was left.
bool WorkerPool::take_part(std::uint32_t worker) {
    std::uint64_t ticket = ticket_;
    do {
        if (next_part(ticket) == parts_of(ticket)) {
            return false;
        }
    } while (!ticket_.compare_exchange_weak(ticket, ticket + 1));
    auto const part = static_cast<std::uint32_t>(next_part(ticket));
    auto const parts = static_cast<std::uint32_t>(parts_of(ticket));
    try {
        call_(work_, part, worker);
    } catch (...) {
        std::lock_guard const lock(mutex_);
        if (!exception_ || part < thrown_by_) {
            exception_ = std::current_exception();
            thrown_by_ = part;
        }
    }
    if (++done_ == parts && worker != 0) {
        { std::lock_guard const lock(mutex_); }  // waits until the caller sleeps or has not checked yet
        has_ended_.notify_one();
    }
    return true;
}

void WorkerPool::wait_for_end(std::uint32_t parts) {
    auto const has_ended = [&] { return done_ == parts; };
    if (becomes_true(has_ended)) {
        return;
    }
    constexpr auto kLookAfter = std::chrono::milliseconds(100);
    std::unique_lock lock(mutex_);
    while (!has_ended_.wait_for(lock, kLookAfter, has_ended)) {
        if (has_background_thread_crashed()) {
            throw WorkerCrashed();
        }
    }
}

void WorkerPool::wake_workers() {
    ++call_number_;
    call_number_.notify_all();
}

void WorkerPool::serve(std::uint32_t worker) {
    for (;;) {
        std::uint32_t const seen = call_number_;
        if (is_closed_) {
            return;
        }
        while (take_part(worker)) {
        }
        if (!becomes_true([&] { return call_number_ != seen; })) {
            call_number_.wait(seen);
        }
    }
}

}  // namespace pogosim
