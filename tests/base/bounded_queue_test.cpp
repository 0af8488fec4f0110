// A bounded queue between threads delivers every item, in order, and never holds more than its limit.
#include "base/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

namespace pogosim {
namespace {

TEST(BoundedQueue, GivesItemsInTheOrderInWhichTheyCame) {
    BoundedQueue<int> queue(3);
    queue.push(1);
    queue.push(2);
    queue.push(3);
    EXPECT_EQ(queue.pop(), 1);
    EXPECT_EQ(queue.pop(), 2);
    EXPECT_EQ(queue.pop(), 3);
}

TEST(BoundedQueue, GivesWhatIsLeftWhenItIsClosedAndThenNothing) {
    BoundedQueue<int> queue(2);
    queue.push(1);
    queue.close();
    EXPECT_EQ(queue.pop(), 1);
    EXPECT_EQ(queue.pop(), std::nullopt);
    EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(BoundedQueue, WhoeverPushesWaitsUntilThereIsRoom) {
    BoundedQueue<int> queue(2);
    std::atomic<int> pushed = 0;
    std::thread producer([&] {
        for (int i = 0; i < 5; ++i) {
            queue.push(i);
            ++pushed;
        }
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(pushed, 2);
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(queue.pop(), i);
    }
    producer.join();
    EXPECT_EQ(pushed, 5);
}

TEST(BoundedQueue, DropsAnItemIfItsProducerGivesUp) {
    BoundedQueue<int> queue(1);
    queue.push(1, [] { return true; });
    queue.push(2, [] { return true; });
    queue.close();
    EXPECT_EQ(queue.pop(), 1);
    EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(BoundedQueue, LosesNothingBetweenSeveralThreads) {
    constexpr int kItems = 2000;
    BoundedQueue<std::unique_ptr<int>> queue(3);
    std::vector<std::atomic<int>> seen(kItems);
    std::vector<std::thread> consumers;
    for (int i = 0; i < 3; ++i) {
        consumers.emplace_back([&] {
            while (auto const item = queue.pop()) {
                ++seen[static_cast<std::size_t>(**item)];
            }
        });
    }
    for (int i = 0; i < kItems; ++i) {
        queue.push(std::make_unique<int>(i));
    }
    queue.close();
    for (std::thread& consumer : consumers) {
        consumer.join();
    }
    for (auto const& count : seen) {
        EXPECT_EQ(count, 1);
    }
}

}  // namespace
}  // namespace pogosim
