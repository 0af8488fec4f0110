// The current robot, on which the functions of the C interface act.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/world_edit.hpp"
#include "robot/controller.hpp"
#include "robot/data_export.hpp"
#include "robot/outbox.hpp"
#include "robot/phase.hpp"
#include "robot/printed_lines.hpp"
#include "world/data_table.hpp"
#include "world/parameter_source.hpp"
#include "world/world.hpp"

namespace pogosim {

/// A variable of the program that was set to the value of a parameter, and can be set to another one.
struct BoundVariable {
    std::string name;  // of the parameter
    void (*read)(ParameterSource& source, std::string const& name, void* variable, std::size_t size) = nullptr;
    void* variable = nullptr;
    std::size_t size = 1;   // of an array, or a text with its end
    std::size_t bytes = 0;  // of all
};

class Controllers;
class RunningCode;

/// What user code can access besides its own robot.
struct RunServices {
    ParameterSource* parameters = nullptr;
    std::mutex parameters_mutex{};  // of parameters and bound_variables, for robots on several threads
    std::uint32_t seed = 0;         // of the run
    DataExport data;
    std::vector<std::span<std::byte>> program_variables{};
    std::span<std::byte> user_data{};  // of all robots and the global step
    std::vector<BoundVariable> bound_variables{};
    bool stop_requested = false;
    std::vector<std::string> started_categories{};  // that pogobot_start() calls name, each once
    std::vector<WarningKind> warned;                // of warn_once
    WorldEdit edit{};
    Controllers* controllers = nullptr;
    bool are_lines_hidden = false;          // of robots: they were printed before
    bool gave_user_data = false;            // of any robot, to callbacks of the run
    PrintedLines* printed_lines = nullptr;  // gets the lines of robots; null: they are not kept

    /// Logs a warning that names the running robot, its tick and the time, the first time in the run that this format
    /// (a literal) is used.
    template <class... Args>
    void warn_once(fmt::format_string<Args...> format, Args&&... args) {
        fmt::string_view const text = format;
        warn_once_of(WarningKind{.text = {text.data(), text.size()}}, format, std::forward<Args>(args)...);
    }

    /// The same, the first time in the run for this kind.
    template <class... Args>
    void warn_once_of(WarningKind const& kind, fmt::format_string<Args...> format, Args&&... args) {
        if (is_new(kind)) {
            warn_of_robot(kind, fmt::format(format, std::forward<Args>(args)...));
        }
    }

    /// A line that a robot has printed.
    void print_line(World const& world, std::uint32_t robot, std::string_view line);

    /// A warning that names a robot, if it is the first one of this kind.
    void warn_first(WarningKind const& kind, std::string const& text);

private:
    bool is_new(WarningKind const& kind) const;
    void warn_of_robot(WarningKind const& kind, std::string const& text);
};

/// Whether a robot's program may return control to the simulator in the middle, see waiting.hpp.
enum class Waiting : std::uint8_t {
    never,       // in callbacks
    for_inputs,  // in user_init: sleeping is over at once
    always,
};

struct Context {
    World* world = nullptr;
    RunServices* services = nullptr;
    Controller* controller = nullptr;  // never null while user code runs
    std::uint32_t robot = kNone;       // index in World::robots; kNone in the context of callback_global_step
    std::size_t device = 0;            // index in World::devices
    Phase phase = Phase::none;
    Waiting waiting = Waiting::never;
    std::int64_t step_us = 0;        // time of the step: from here on, a robot waits
    std::string* printed = nullptr;  // what was printed here since the last line end
    Outbox* outbox = nullptr;        // of the part of the swarm to which the robot belongs; null: all robots run here
    bool is_system = false;          // a callback of the whole run: global setup, data schema, global step
    bool has_own_memory = false;     // its variables are its own
    bool sees_world = false;         // one of these or a click, in which the functions of world.h may be called

    bool has_robot() const { return robot != kNone; }
    /// False in the global step and in a wall, which have no place.
    bool has_body() const { return has_robot() && body() != kNone; }
    std::uint32_t body() const { return world->robots.body[robot]; }
    RobotSpec const& spec() const { return world->spec_of(robot); }
    Devices& devices() const { return world->devices; }
    std::int64_t& clock_us() const { return world->devices.clock_us[device]; }
};

/// The context of this thread.
extern constinit thread_local Context context;

/// While this exists, the thread works for no robot.
class WithoutRobot {
public:
    WithoutRobot() : before_(context) { context = {}; }
    ~WithoutRobot() { context = before_; }
    WithoutRobot(WithoutRobot const&) = delete;
    WithoutRobot& operator=(WithoutRobot const&) = delete;

private:
    Context before_;
};

/// Where the running robot's messages go.
inline TransmissionQueue& current_air() {
    return context.outbox != nullptr ? context.outbox->air : context.world->air;
}

/// The robot that runs in a thread, or ran last, for messages from another thread.
struct RunningRobot {
    Context its_context;
    std::uint32_t ticks = 0;
};
RunningRobot running_robot();
void set_running_robot(RunningRobot const& robot);

/// "user_step of robot #3 of category 'robots', tick 17": the user code that is running, or ran last.
std::string current_place();

/// "robot #3 of category 'robots', tick 17", or the callback when it is one of the whole run.
std::string current_robot_name();

/// Which robot's code runs, for messages of the crash handler and the watchdog: of all robots of this process, as the
/// context of each thread has it.
RunningCode const& code_of_robots();

}  // namespace pogosim
