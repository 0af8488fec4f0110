// How the simulation and its window talk. Each runs in a thread of its own; neither waits for the other, except the
// simulation while it is paused or ahead of time.
//
//     simulation ── Moment: snapshot, status, inspected robot ──► window
//                ◄── MomentRequest: what the next one must have ──
//                ◄── Command: pause, click, drag, quit ─────────
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "view/messages.hpp"

namespace pogosim {

class Exchange {
public:
    using Clock = std::chrono::steady_clock;

    // The window's side.

    /// The window is there, or why it cannot be opened.
    void report_opened(std::string const& error);
    void report_end(WindowEnd end, std::string const& error);
    void send(Command const& command);
    /// Replaces the request before.
    void request(MomentRequest request);
    /// The newest moment; null when there has been none since the last call.
    std::shared_ptr<Moment const> take_moment();
    /// True when the simulation wants the window to close.
    bool is_closing() const;

    // The simulation's side.

    /// Waits for the window. The error, empty when it is open; absent when there is no answer in time.
    std::optional<std::string> wait_until_opened(std::chrono::milliseconds longest);
    /// The first of the commands that have not been taken; absent: there is none.
    std::optional<Command> take_command();
    /// Whether a command that has not been taken ends the run, or the window has ended: a long computation for the
    /// window may stop.
    bool end_is_asked() const;
    /// The request since the last call.
    std::optional<MomentRequest> take_request();
    /// Records in a moment that the window has not taken are moved to this one.
    void publish(std::shared_ptr<Moment> moment);
    /// Returns at that time, or earlier with a command or a request.
    void wait_until(Clock::time_point time);
    /// Absent while the window is open.
    std::optional<WindowEnd> end() const;
    /// Why the window failed.
    std::string error() const;
    void close();
    /// True when the window has ended in time.
    bool wait_until_ended(std::chrono::milliseconds longest);

private:
    mutable std::mutex mutex_;
    std::condition_variable for_simulation_;
    std::optional<std::string> opened_;  // the error, empty when there is none
    std::optional<WindowEnd> end_;
    std::string error_;
    std::deque<Command> commands_;
    std::optional<MomentRequest> request_;
    std::shared_ptr<Moment const> moment_;
    bool closing_ = false;
};

// Inline, since two libraries need them.

inline void Exchange::report_opened(std::string const& error) {
    std::lock_guard const lock(mutex_);
    opened_ = error;
    for_simulation_.notify_all();
}

inline void Exchange::report_end(WindowEnd end, std::string const& error) {
    std::lock_guard const lock(mutex_);
    end_ = end;
    error_ = error;
    for_simulation_.notify_all();
}

inline void Exchange::send(Command const& command) {
    std::lock_guard const lock(mutex_);
    // A mouse moves more often than a slow run reads commands: only the last place counts.
    auto const* const place = std::get_if<DragObject>(&command);
    auto* const last = commands_.empty() ? nullptr : std::get_if<DragObject>(&commands_.back());
    if (place != nullptr && last != nullptr) {
        *last = *place;
    } else {
        commands_.push_back(command);
    }
    for_simulation_.notify_all();
}

inline void Exchange::request(MomentRequest request) {
    std::lock_guard const lock(mutex_);
    request_ = request;
    for_simulation_.notify_all();
}

inline std::shared_ptr<Moment const> Exchange::take_moment() {
    std::lock_guard const lock(mutex_);
    return std::exchange(moment_, nullptr);
}

inline bool Exchange::is_closing() const {
    std::lock_guard const lock(mutex_);
    return closing_;
}

inline std::optional<std::string> Exchange::wait_until_opened(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    for_simulation_.wait_for(lock, longest, [this] { return opened_.has_value(); });
    return opened_;
}

inline std::optional<Command> Exchange::take_command() {
    std::lock_guard const lock(mutex_);
    if (commands_.empty()) {
        return std::nullopt;
    }
    Command command = std::move(commands_.front());
    commands_.pop_front();
    return command;
}

inline bool Exchange::end_is_asked() const {
    std::lock_guard const lock(mutex_);
    return end_ || std::ranges::any_of(commands_, [](Command const& command) {
               return std::holds_alternative<Quit>(command) || std::holds_alternative<Restart>(command);
           });
}

inline std::optional<MomentRequest> Exchange::take_request() {
    std::lock_guard const lock(mutex_);
    return std::exchange(request_, std::nullopt);
}

inline void Exchange::publish(std::shared_ptr<Moment> moment) {
    std::lock_guard const lock(mutex_);
    if (moment_ != nullptr) {
        moment->recorded.insert(moment->recorded.begin(), moment_->recorded.begin(), moment_->recorded.end());
    }
    moment_ = std::move(moment);
}

inline void Exchange::wait_until(Clock::time_point time) {
    std::unique_lock lock(mutex_);
    for_simulation_.wait_until(lock, time, [this] { return !commands_.empty() || request_ || end_; });
}

inline std::optional<WindowEnd> Exchange::end() const {
    std::lock_guard const lock(mutex_);
    return end_;
}

inline std::string Exchange::error() const {
    std::lock_guard const lock(mutex_);
    return error_;
}

inline void Exchange::close() {
    std::lock_guard const lock(mutex_);
    closing_ = true;
}

inline bool Exchange::wait_until_ended(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    return for_simulation_.wait_for(lock, longest, [this] { return end_.has_value(); });
}

}  // namespace pogosim
