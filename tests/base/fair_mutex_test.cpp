#include "base/fair_mutex.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

using namespace pogosim;

TEST(FairMutex, OneThreadAtATimeHasIt) {
    FairMutex mutex;
    int count = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int j = 0; j < 500; ++j) {
                std::lock_guard const lock(mutex);
                ++count;
                mutex.yield();
                ++count;
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(count, 4 * 500 * 2);
}

TEST(FairMutex, ThreadThatWaitsGetsItBeforeTheOneThatYieldsGetsItBack) {
    FairMutex mutex;
    std::atomic<bool> waits = false;
    bool had_it = false;
    mutex.lock();
    std::thread other([&] {
        waits = true;
        std::lock_guard const lock(mutex);
        had_it = true;
    });
    while (!waits) {
        std::this_thread::yield();
    }
    // It asks for it within a few turns.
    for (int i = 0; i < 1'000'000 && !had_it; ++i) {
        mutex.yield();
    }
    EXPECT_TRUE(had_it);
    mutex.unlock();
    other.join();
}
