// A mutex that threads get in the order in which they asked for it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace pogosim {

/// A thread that gives it back and asks again at once goes to the end of the queue, which std::mutex does not promise.
/// Usable with std::lock_guard.
class FairMutex {
public:
    void lock() {
        std::unique_lock lock(mutex_);
        std::uint64_t const ticket = next_ticket_++;
        turn_.wait(lock, [&] { return ticket == served_; });
    }

    void unlock() {
        {
            std::lock_guard const lock(mutex_);
            ++served_;
        }
        turn_.notify_all();
    }

    /// Lets the threads have it that are waiting now. The caller holds it, before and afterwards.
    void yield() {
        {
            std::lock_guard const lock(mutex_);
            if (next_ticket_ - served_ == 1) {
                return;
            }
        }
        unlock();
        lock();
    }

private:
    std::mutex mutex_;
    std::condition_variable turn_;
    std::uint64_t next_ticket_ = 0;
    std::uint64_t served_ = 0;  // the ticket of the thread that holds it, or may
};

}  // namespace pogosim
