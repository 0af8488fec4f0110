// What the simulation and its window tell each other. Each runs in a thread of its own; neither waits for the other,
// except the simulation while it is paused or ahead of time.
//
//     simulation ── Moment: snapshot, status, inspected robot ──► window
//                ◄── Wish: what the next moment must have ──────
//                ◄── Command: pause, click, drag, quit ─────────
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "render/inspection.hpp"
#include "render/painter.hpp"
#include "render/snapshot.hpp"

namespace pogosim {

struct Pause {
    bool on = true;
};
/// One step, then a pause.
struct StepOnce {};
struct SetSpeedUp {
    double factor = 1.0;  // simulated seconds per second; 0: as fast as possible
};
/// callback_robot_click of a robot that has been selected.
struct ClickRobot {
    std::uint32_t robot = 0;
};
/// The object stays there until it is let go.
struct HoldObject {
    std::uint32_t object = 0;  // index into Scenery::objects
    Vec2 centre_mm;            // where the mean of its bodies is to be
};
struct LetGo {};
/// How a window looks and runs, for one that takes its place.
struct WindowState {
    int x_px = 0;
    int y_px = 0;
    PictureSize size;
    bool panels = true;
    bool plot = false;
    std::size_t column = 0;  // in the plot
    double speed_up = 1.0;
    PaintOptions options;
};
/// Ends the run and starts it again with this seed.
struct Restart {
    std::uint32_t seed = 0;
    std::optional<WindowState> window{};  // that the new run has
};
struct Quit {};
/// A line for the log.
struct Note {
    std::string text;
};
using Command = std::variant<Pause, StepOnce, SetSpeedUp, ClickRobot, HoldObject, LetGo, Restart, Quit, Note>;

/// What the window wants to show next.
struct Wish {
    SnapshotParts parts;
    bool follow_trails = false;            // so that they are there when `parts` ask for them
    std::optional<std::uint32_t> robot{};  // to inspect
};

struct RunStatus {
    bool paused = false;
    double asked_speed_up = 1.0;  // 0: as fast as possible
    double speed_up = 0.0;        // reached in the last second; 0: not known yet
    bool too_slow = false;        // the machine cannot keep the asked one
    bool touched = false;         // by the user's hand: the run is no longer that of its seed alone
};

/// One moment of the run.
struct Moment {
    Snapshot snapshot;
    RunStatus status;
    std::optional<Inspection> inspection{};
    std::vector<RecordedValues> recorded{};  // since the moment before
};

/// What stays the same while the window is open.
struct WindowSetup {
    std::string title;
    PictureSize size;
    std::optional<WindowState> restored{};  // of the run before, instead of what is said below
    std::shared_ptr<Scenery const> scenery;
    PaintOptions options;  // at the start
    bool panels = true;    // shown at the start
    std::uint32_t seed = 0;
    double duration_s = 0.0;  // of the whole run
    double time_step_s = 0.01;
    double speed_up = 1.0;             // asked for, at the start
    std::vector<std::string> columns;  // of RecordedValues
    // Called in the window's thread once the run is to end, be it in a long step; says by what.
    std::function<void(char const* what)> hurry;
};

/// How a window ended.
enum class WindowEnd { closed, display_lost, failed };

class Exchange {
public:
    using Clock = std::chrono::steady_clock;

    // The window's side.

    /// The window is there, or why it cannot be opened.
    void report_opened(std::string const& error);
    void report_end(WindowEnd end, std::string const& error);
    void send(Command const& command);
    /// Replaces the wish before.
    void request(Wish wish);
    /// The newest moment; null when there has been none since the last call.
    std::shared_ptr<Moment const> take_moment();
    /// True when the simulation wants the window to close.
    bool is_closing() const;

    // The simulation's side.

    /// Waits for the window. The error, empty when it is open; absent when there is no answer in time.
    std::optional<std::string> wait_until_opened(std::chrono::milliseconds longest);
    std::vector<Command> take_commands();
    /// The wish since the last call.
    std::optional<Wish> take_wish();
    /// What was recorded in a moment that the window has not taken goes over to this one.
    void publish(std::shared_ptr<Moment> moment);
    /// Returns at that time, or earlier with a command or a wish.
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
    std::vector<Command> commands_;
    std::optional<Wish> wish_;
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
    // A mouse reports faster than a slow run takes notice: only the last place counts.
    auto const* const place = std::get_if<HoldObject>(&command);
    auto* const last = commands_.empty() ? nullptr : std::get_if<HoldObject>(&commands_.back());
    if (place != nullptr && last != nullptr) {
        *last = *place;
    } else {
        commands_.push_back(command);
    }
    for_simulation_.notify_all();
}

inline void Exchange::request(Wish wish) {
    std::lock_guard const lock(mutex_);
    wish_ = wish;
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

inline std::vector<Command> Exchange::take_commands() {
    std::lock_guard const lock(mutex_);
    return std::exchange(commands_, {});
}

inline std::optional<Wish> Exchange::take_wish() {
    std::lock_guard const lock(mutex_);
    return std::exchange(wish_, std::nullopt);
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
    for_simulation_.wait_until(lock, time, [this] { return !commands_.empty() || wish_ || end_; });
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
