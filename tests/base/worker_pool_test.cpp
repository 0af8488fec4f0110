// All parts are done, once each, by several threads, and exceptions come out.
#include "base/worker_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace pogosim {
namespace {

TEST(WorkerPool, DoesEachPartOnceInEachRound) {
    for (std::uint32_t const size : {1U, 2U, 3U, 8U}) {
        WorkerPool pool(size);
        ASSERT_EQ(pool.size(), size);
        std::vector<int> times(1000, 0);
        for (std::uint32_t round = 1; round <= 1000; ++round) {
            std::uint32_t const parts = round * 7 % 1001;
            std::ranges::fill(times, 0);
            pool.run(parts, [&](std::uint32_t part, std::uint32_t worker) {
                EXPECT_LT(worker, size);
                ++times[part];
            });
            ASSERT_EQ(std::accumulate(times.begin(), times.end(), 0), static_cast<int>(parts));
            ASSERT_LE(*std::ranges::max_element(times), 1);
        }
    }
}

TEST(WorkerPool, WorkersHaveNumbersOfTheirOwn) {
    WorkerPool pool(3);
    std::vector<std::atomic<int>> inside(3);
    pool.run(1000, [&](std::uint32_t, std::uint32_t worker) {
        EXPECT_EQ(++inside[worker], 1);
        --inside[worker];
    });
}

TEST(WorkerPool, AllWorkersWork) {
    WorkerPool pool(3);
    std::atomic<std::uint32_t> present = 0;
    pool.run(3, [&](std::uint32_t, std::uint32_t) {
        ++present;
        while (present < 3) {  // none of them can take two parts
            std::this_thread::yield();
        }
    });
    EXPECT_EQ(present, 3U);
}

TEST(WorkerPool, RangesCoverAllItems) {
    for (std::uint32_t const size : {1U, 4U}) {
        WorkerPool pool(size);
        for (std::uint32_t const count : {0U, 1U, 9U, 10U, 11U, 20U, 1000U}) {
            std::vector<int> times(count, 0);
            std::atomic<std::uint32_t> ranges = 0;
            pool.run_ranges(count, 10, [&](WorkRange range) {
                ++ranges;
                EXPECT_LT(range.part, pool.range_count(count, 10));
                EXPECT_TRUE(range.last - range.first >= 10 || range.last - range.first == count);
                for (std::uint32_t i = range.first; i < range.last; ++i) {
                    ++times[i];
                }
            });
            EXPECT_EQ(times, std::vector<int>(count, 1));
            EXPECT_EQ(ranges, pool.range_count(count, 10));
            float const largest =
                pool.max_of_ranges(count, 10, [](WorkRange range) { return static_cast<float>(range.last); });
            EXPECT_EQ(largest, static_cast<float>(count));
        }
    }
}

TEST(WorkerPool, ExceptionOfTheLowestPartComesOutWhenAllAreDone) {
    WorkerPool pool(4);
    for (int round = 0; round < 100; ++round) {
        std::atomic<int> calls = 0;
        try {
            pool.run(100, [&](std::uint32_t part, std::uint32_t) {
                ++calls;
                if (part % 10 == 3) {
                    throw std::runtime_error(std::to_string(part));
                }
            });
            FAIL() << "nothing was thrown";
        } catch (std::runtime_error const& error) {
            EXPECT_STREQ(error.what(), "3");
        }
        EXPECT_EQ(calls, 100);
    }
    int calls = 0;
    pool.run(1, [&](std::uint32_t, std::uint32_t) { ++calls; });
    EXPECT_EQ(calls, 1);
}

TEST(WorkerPool, WorksAfterALongSleep) {
    WorkerPool pool(2);
    for (int round = 0; round < 3; ++round) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        std::atomic<int> calls = 0;
        pool.run(10, [&](std::uint32_t, std::uint32_t) { ++calls; });
        EXPECT_EQ(calls, 10);
    }
}

}  // namespace
}  // namespace pogosim
