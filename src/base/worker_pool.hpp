// Threads that share the work of a time step and wait in between.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pogosim {

/// A worker has crashed, see background_thread.hpp; its work will never be finished.
struct WorkerCrashed : std::exception {
    char const* what() const noexcept override { return "a worker thread has crashed"; }
};

/// Items from `first` to `last` - 1.
struct WorkRange {
    std::uint32_t first;
    std::uint32_t last;
    std::uint32_t part;    // number of the range: 0, 1, ...
    std::uint32_t worker;  // number of the worker, to index scratch memory
};

class WorkerPool {
public:
    /// `size`: number of working threads, > 0, including the one that calls run(). There are fewer if the system cannot
    /// create so many.
    explicit WorkerPool(std::uint32_t size = 1);
    ~WorkerPool();

    WorkerPool(WorkerPool const&) = delete;
    WorkerPool& operator=(WorkerPool const&) = delete;

    std::uint32_t size() const { return static_cast<std::uint32_t>(threads_.size()) + 1; }

    /// Calls work(part, worker) once for each part from 0 to `parts` - 1, and returns when all calls have returned.
    /// `worker`, below size(), is the number of the thread that makes the call, to index scratch memory. The assignment
    /// of parts to workers is arbitrary: results must not depend on it. If calls throw, all others are made
    /// nevertheless, and the exception of the lowest part is rethrown. Throws WorkerCrashed. `parts`: up to 2^20.
    template <class Work>
    void run(std::uint32_t parts, Work const& work) {
        if (size() == 1 || parts == 1) {
            for (std::uint32_t part = 0; part < parts; ++part) {
                work(part, 0U);
            }
            return;
        }
        share(parts, &work, [](void const* called, std::uint32_t part, std::uint32_t worker) {
            (*static_cast<Work const*>(called))(part, worker);
        });
    }

    /// Calls work(WorkRange) for consecutive ranges of `count` items, as run() does. A range has at least `least`
    /// items, or all.
    template <class Work>
    void run_ranges(std::uint32_t count, std::uint32_t least, Work const& work) {
        std::uint32_t const parts = range_count(count, least);
        run(parts, [&](std::uint32_t part, std::uint32_t worker) {
            auto const bound = [&](std::uint32_t at) {
                return static_cast<std::uint32_t>(std::uint64_t{count} * at / parts);
            };
            work(WorkRange{.first = bound(part), .last = bound(part + 1), .part = part, .worker = worker});
        });
    }

    /// The maximum of of(WorkRange) over the ranges of run_ranges().
    template <class Of>
    float max_of_ranges(std::uint32_t count, std::uint32_t least, Of const& of) {
        largest_.resize(range_count(count, least));
        run_ranges(count, least, [&](WorkRange range) { largest_[range.part] = of(range); });
        return *std::max_element(largest_.begin(), largest_.end());
    }

    /// Number of ranges in run_ranges(): more than workers, since some take longer than others. At least 1.
    std::uint32_t range_count(std::uint32_t count, std::uint32_t least) const;

private:
    using Call = void (*)(void const* work, std::uint32_t part, std::uint32_t worker);

    void share(std::uint32_t parts, void const* work, Call call);
    void serve(std::uint32_t worker);
    bool take_part(std::uint32_t worker);
    void wait_for_end(std::uint32_t parts);
    void wake_workers();

    std::vector<std::thread> threads_;
    std::vector<float> largest_;  // for each range

    // The work to do: number of the round, number of its parts, and the next part, in one word, so that no worker takes
    // a part of a later round by mistake.
    std::atomic<std::uint64_t> ticket_ = 0;
    std::atomic<std::uint32_t> done_ = 0;  // number of finished parts of the round
    void const* work_ = nullptr;
    Call call_ = nullptr;

    // Workers sleep until this changes. Not a condition variable, which fails if a waiting thread crashes.
    std::atomic<std::uint32_t> call_number_ = 0;
    std::atomic<bool> is_closed_ = false;

    std::mutex mutex_;  // protects what follows
    std::condition_variable has_ended_;
    std::exception_ptr exception_;
    std::uint32_t thrown_by_ = 0;  // the part that threw, if there is an exception
};

}  // namespace pogosim
