// Messages between the simulation and its window.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "render/camera.hpp"
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
struct DragObject {
    std::uint32_t object = 0;  // index into Scenery::objects
    Vec2 centre_mm;            // where the mean of its bodies is to be
};
struct DropObject {};
/// The run goes on from this time, which was a while ago.
struct GoBack {
    double time_s = 0.0;
};
/// The run pauses when this becomes true of a robot, see Condition; empty: never.
struct PauseWhen {
    std::string condition;
};
/// The state of a window, for the one that replaces it.
struct WindowState {
    int x_px = 0;
    int y_px = 0;
    PictureSize size;
    bool full_screen = false;        // place and size are those without
    std::optional<Camera> camera{};  // absent: the whole arena
    bool paused = false;
    bool panels = true;
    bool plot = false;
    std::size_t column = 0;  // in the plot
    double speed_up = 1.0;
    ViewOptions options;
};
/// Ends the run and starts it again with this seed.
struct Restart {
    std::uint32_t seed = 0;
    bool overwrite = false;               // the files of the run before; else they are kept beside the new ones
    std::optional<WindowState> window{};  // that the new run has
};
struct Quit {};
/// A line for the log.
struct Note {
    std::string text;
};
using Command = std::variant<Pause, StepOnce, SetSpeedUp, ClickRobot, DragObject, DropObject, GoBack, PauseWhen,
                             Restart, Quit, Note>;

/// The parts of the next moment that the window wants.
struct MomentRequest {
    SnapshotParts parts{};
    std::optional<std::uint32_t> robot{};  // to inspect
};

struct RunStatus {
    bool paused = false;
    double asked_speed_up = 1.0;    // 0: as fast as possible
    double speed_up = 0.0;          // reached in the last second; 0: not known yet
    bool too_slow = false;          // the machine cannot keep the asked one
    bool is_over = false;           // its files are complete; the window is still open
    bool touched = false;           // by the user's hand: the run is no longer that of its seed alone
    double earliest_s = 0.0;        // to which it can go back
    std::string why_no_way_back{};  // empty: it can go back
    std::string why_paused{};       // by a condition: of which robot it is true, and its values
    std::string wrong_condition{};  // the mistake in the condition to pause by; empty: there is none
};

/// One moment of the run.
struct Moment {
    Snapshot snapshot;
    RunStatus status;
    std::optional<Inspection> inspection{};
    std::vector<RecordedValues> recorded{};  // since the moment before
};

/// Whether the run can be started again, and what that would overwrite.
struct RestartCheck {
    std::string problem{};                   // such as a configuration that is wrong by now; empty: there is none
    std::vector<std::string> overwritten{};  // and the name to keep it under: "run.feather -> run.1.feather"
};

/// The constants of an open window.
struct WindowSetup {
    std::string title;
    PictureSize size;
    std::optional<WindowState> restored{};  // of the run before, instead of what is said below
    std::shared_ptr<Scenery const> scenery;
    ViewOptions options;  // at the start
    bool panels = true;   // shown at the start
    std::uint32_t seed = 0;
    double duration_s = 0.0;  // of the whole run
    double time_step_s = 0.01;
    double speed_up = 1.0;             // asked for, at the start
    std::vector<std::string> columns;  // of RecordedValues
    std::vector<std::string> values;   // of robots, for colours, heat maps and conditions, see RobotValues
    // Called in the window's thread once the run is to end, be it in a long step; says by what.
    std::function<void(char const* what)> hurry;
    std::function<RestartCheck()> check_restart;  // called in the window's thread
};

/// How a window ended.
enum class WindowEnd { closed, display_lost, failed };

}  // namespace pogosim
