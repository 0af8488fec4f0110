// A run with a window: keeps it at a speed to watch, shows it, and does what the user asks for between two steps.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/scenario.hpp"
#include "process/crash_handler.hpp"
#include "sim/condition.hpp"
#include "sim/pacer.hpp"
#include "sim/robot_values.hpp"
#include "sim/snapshot_taker.hpp"
#include "sim/state_history.hpp"
#include "sim/window_module.hpp"
#include "view/exchange.hpp"
#include "view/messages.hpp"
#include "world/world.hpp"

namespace pogosim {

class Simulation;

class WindowDriver {
public:
    /// Opens the window. `simulation` has been started and outlives this. Throws std::runtime_error, with the reason
    /// why there is no window.
    WindowDriver(Simulation& simulation, WindowSetup const& setup);
    ~WindowDriver();

    WindowDriver(WindowDriver const&) = delete;
    WindowDriver& operator=(WindowDriver const&) = delete;

    /// Call it before each step: returns when the step may begin, or when the run is over.
    std::optional<UserFailure> wait_for_step();

    /// Call it after each step.
    void note_step();

    /// Call it when the run is over and its files are complete: shows its last moment until the user closes the window,
    /// or wants the run again.
    void show_end();

    /// The user has ended the run.
    bool is_over() const { return is_over_; }

    /// At the end of the run: how the user wants it again, even if the last step was aborted for it.
    std::optional<Restart> restart();

private:
    bool is_open() const { return window_ != nullptr; }
    void note_window_end();
    std::optional<UserFailure> carry_out_commands();
    std::optional<UserFailure> carry_out(Command const& command);
    /// Moves the object that the user drags to the mouse.
    void drag();
    void show_if_wanted();
    /// Takes the run back to a time, step by step from the state before it. The end of the run, or of the window, ends
    /// the way there.
    std::optional<UserFailure> go_back(double time_s);
    /// Reads the condition to pause by.
    void pause_when(std::string const& condition);
    /// Pauses if the condition has become true of a robot since it was looked at last.
    void pause_if_true();

    Simulation& simulation_;
    SnapshotTaker& taker_;
    Pacer pacer_;
    bool paused_ = false;
    std::unique_ptr<OpenWindow> window_;  // null: it has gone
    std::optional<DragObject> dragged_;
    int steps_asked_ = 0;  // while paused
    StateHistory states_;
    RobotValues values_;
    std::optional<Condition> condition_;
    std::string wrong_condition_;
    std::string why_paused_;
    std::optional<std::size_t> true_of_;  // the first robot of which the condition was true after the last step
    bool is_over_ = false;
    bool shows_end_ = false;
    std::optional<Restart> restart_;
};

/// The part that follows from the configuration; Simulation::open_window() sets the rest.
WindowSetup window_setup(Scenario const& scenario, World const& world, std::string const& program_name);

}  // namespace pogosim
