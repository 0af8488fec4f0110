// A first-in, first-out queue between threads, with a limited number of waiting items.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace pogosim {

template <class Item>
class BoundedQueue {
public:
    /// `capacity`: the most items that wait, > 0.
    explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

    /// Waits until there is room; drops the item as soon as `gives_up()`, which is called every 0.1 s, is true. Must
    /// not be called after close().
    template <class GivesUp>
    void push(Item item, GivesUp const& gives_up) {
        constexpr auto kPatience = std::chrono::milliseconds(100);
        std::unique_lock lock(mutex_);
        while (!has_room_.wait_for(lock, kPatience, [this] { return items_.size() < capacity_; })) {
            if (gives_up()) {
                return;
            }
        }
        items_.push_back(std::move(item));
        has_items_.notify_one();
    }

    void push(Item item) {
        push(std::move(item), [] { return false; });
    }

    /// Waits for the next item. None once the queue is closed and empty.
    std::optional<Item> pop() {
        std::unique_lock lock(mutex_);
        has_items_.wait(lock, [this] { return !items_.empty() || is_closed_; });
        if (items_.empty()) {
            return std::nullopt;
        }
        std::optional<Item> item(std::move(items_.front()));
        items_.pop_front();
        has_room_.notify_one();
        return item;
    }

    /// Declares that no more items will be pushed.
    void close() {
        std::lock_guard const lock(mutex_);
        is_closed_ = true;
        has_items_.notify_all();
    }

private:
    std::size_t const capacity_;
    std::mutex mutex_;
    std::condition_variable has_room_;
    std::condition_variable has_items_;
    std::deque<Item> items_;
    bool is_closed_ = false;
};

}  // namespace pogosim
