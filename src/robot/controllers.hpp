// The user's program on every robot: start, ticks, callbacks. The only place that calls user code. Every public
// function that does so belongs inside call_user_code().
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/state_bytes.hpp"
#include "brain/brain.hpp"
#include "process/fibers.hpp"
#include "process/program_image.hpp"
#include "process/program_memory.hpp"
#include "robot/context.hpp"
#include "robot/function_times.hpp"
#include "robot/robot_memory.hpp"
#include "robot/shared_state.hpp"
#include "world/world.hpp"

namespace pogosim {

class Controllers {
public:
    /// Makes a controller for each robot of the world, whose devices are set up, and one for the global step.
    /// `services` and `world` outlive this.
    Controllers(ProgramImage image, World& world, RunServices& services, std::uint64_t seed, std::size_t stack_bytes);
    ~Controllers();

    Controllers(Controllers const&) = delete;
    Controllers& operator=(Controllers const&) = delete;

    /// While this exists, the callbacks of the whole run are those that this program has set.
    class Thread {
    public:
        explicit Thread(Controllers& controllers);
        ~Thread();
        Thread(Thread const&) = delete;
        Thread& operator=(Thread const&) = delete;

    private:
        Controllers& controllers_;
    };

    /// From start() on, each robot has its own copy of the program's variables, and so has the global step. Throws
    /// ConfigError for a program whose variables are not known.
    void give_robots_own_memory();

    ProgramImage const& image() const { return image_; }

    /// The running robot restarts at the beginning of the next step: main() and user_init run anew, with variables as
    /// the program starts with. Returns in callbacks and in user_init, which end first; else it does not return.
    void ask_for_restart();

    /// The running robot waits: its program goes on in the first step in which its clock is reached. Returns then.
    void wait();

    /// Whether a robot has waited in the middle of its program.
    bool has_waited() const { return has_waited_; }

    /// Null: robots share the program's variables.
    RobotMemory* own_memory() const { return own_memory_.get(); }

    /// Gives a variable another value: that of the program, or those of all robots.
    void set_for_all(BoundVariable const& bound, ParameterSource& source);

    /// Constructs the user data of C++ programs, runs main() for each robot, then callback_global_setup, then every
    /// user_init.
    void start();

    /// callback_create_data_schema: fills the services' columns.
    void declare_columns();

    /// One step: begin_step(), run_robots() of all, end_step().
    void run_step();

    /// How many robots this program drives: not a host, nor a script.
    std::size_t driven_count() const;

    /// The part of a step before the robots: restarts, and the global step. While a robot is switched off, only
    /// callback_export_data, callback_robot_end and callback_robot_click run.
    void begin_step();

    /// The robots from `first` to `last` - 1 that are due. Those that share nothing may run on several threads at a
    /// time, each with an outbox of its own (Context::outbox).
    void run_robots(std::uint32_t first, std::uint32_t last);

    /// The part of a step after the robots: checks of debug builds.
    void end_step() const;

    /// Puts messages on the air, lines and warnings into the log. What is in the outbox is lost.
    void take_over(Outbox& outbox);

    /// Warns of variables that robots share by mistake, unless each has its own.
    void warn_of_shared_variables() const;

    /// Why run_robots() must not run on several threads, see why_one_after_the_other(); empty: it may.
    std::string why_one_after_the_other() const;
    ConfiguredVariables configured_variables() const;
    /// A callback of the whole run has had access to robots' user data: from then on, these may share memory.
    bool gave_user_data() const { return services_.gave_user_data; }

    /// callback_export_data of one robot, index `object` in World::objects, fills `cells`: one for each of the user's
    /// columns, empty before. False: the program wants no row.
    bool export_row(std::size_t robot, std::uint32_t object, std::span<CellValue> cells);

    /// callback_robot_click of one robot. False: it has none.
    bool click(std::uint32_t robot);

    /// callback_robot_end of every robot.
    void end();

    /// Warns, once for each category, of functions of robots that have not returned for long.
    void warn_of_unreturned_calls_at_end();

    /// Warns about stacks for which a real robot has no room.
    void warn_of_stacks() const;

    /// Tells what has become of messages, commands, writes to flash memory and programs. `arrivals`: messages that
    /// reached robots in the whole run.
    void tell_at_end(std::uint64_t arrivals) const;

    /// Tells of columns that the program has declared and never set. `fields`: those of the data file; absent: all.
    void tell_of_unset_columns(std::optional<std::vector<std::string>> const& fields) const;

    /// Logs incomplete lines that robots have printed. Called after the last call of user code.
    void print_unfinished_lines();

    /// Ticks this robot has executed.
    std::uint32_t ticks(std::size_t robot) const { return world_.devices.ticks[robot]; }

    /// The state of this robot's controller between two of its ticks.
    Controller const& controller_of(std::size_t robot) const { return controllers_[robot]; }

    std::span<Controller const> all() const { return controllers_; }

    /// The user data of all robots: bytes from one robot's to the next one's.
    std::size_t user_data_stride() const;

    /// The highest main_loop_hz of all robots.
    int highest_loop_hz() const;
    /// From now on, warns of robots whose main_loop_hz is so high that they skip ticks.
    void watch_loop_rates();

    /// Set by SET_CALLBACK(), for the run as a whole; variables of each thread.
    struct Callbacks {
        void (*global_setup)() = nullptr;
        void (*create_data_schema)() = nullptr;
        void (*global_step)() = nullptr;

        friend bool operator==(Callbacks const&, Callbacks const&) = default;
    };
    static Callbacks callbacks_of_thread();
    static void set_callbacks_of_thread(Callbacks const& callbacks);

    /// What the program is on all robots between two steps.
    struct Saved {
        std::vector<Controller> controllers;
        Controller system;
        Callbacks callbacks;
        std::vector<std::byte> user_data;
        std::vector<std::byte> variables;  // of the program
        std::optional<RobotMemory::Saved> own_memory;
        std::vector<SavedFiber> fibers;
        DataExport columns;
        std::vector<BoundVariable> bound_variables;
        bool is_restart_due = false;
        bool gave_user_data = false;

        /// The memory that it takes, about.
        std::size_t byte_count() const;
    };
    Saved save();
    void restore(Saved const& saved);
    std::string why_not_saved() const;

    /// Why it cannot be saved for another process, with append_state(), at any time; empty: it can. Then, it can where
    /// why_not_saved() is empty and no robot is_waiting_in_middle().
    std::string why_never_portable() const;
    std::string why_state_is_elsewhere() const;
    bool is_waiting_in_middle() const;

    /// Appends the state for another process of the same program. Throws ConfigError for a program that keeps
    /// addresses of memory that only this process has.
    void append_state(StateWriter& state);

    /// Goes on from there, after start(). Throws ForeignState.
    void take_state(StateReader& state);

    /// Bytes of one robot's user data.
    std::size_t user_data_bytes() const { return image_.user_data_bytes; }

private:
    std::vector<std::span<std::byte>> portable_variables() const;
    std::string name_at(std::byte const* place) const;
    void allocate_user_data();
    void draw_seeds(std::uint64_t seed);
    void count_time();
    void enter(std::uint32_t robot, Phase phase);
    void enter_as_system(std::uint32_t robot, Phase phase);
    [[gnu::noinline]] static void leave();  // see can_change_threads()
    void construct_static_objects();
    void construct_user_data(std::uint32_t robot);
    void run_main(std::uint32_t robot);
    void run_init(std::uint32_t robot);
    void start_programs();
    void start_sdk_program();
    void run_sdk_main(std::uint32_t robot);
    void warn_of_late_callbacks();
    void run_on_fiber(std::uint32_t robot, void (Controllers::*part)(std::uint32_t));
    Fiber& free_fiber();
    void go_on(std::uint32_t robot);
    void warn_of_unreturned_calls_if_due();
    void warn_of_unreturned_calls(std::int64_t least_us, bool most);
    void warn_of_unreturned_call(std::uint32_t robot, std::uint32_t count, std::uint32_t alive) const;
    bool is_due(std::uint32_t robot) const;
    bool is_waiting(std::uint32_t robot) const;
    struct Turns;
    void run_range(RobotRange range);
    void take_turns(Turns& turns);
    void restart_robots();
    void restart(std::uint32_t robot);
    void repeat_global_setup(std::uint32_t robot);
    void run_global_setup();
    void call(std::uint32_t robot, Phase phase, void (*function)(), bool sees_world = false);
    void call_as_system(std::uint32_t robot, Phase phase, void (*function)());
    void tick(std::uint32_t robot);
    template <class Call>
    void for_each_robot(Call const& call) {
        for (RobotRange const range : ranges_) {
            for (std::uint32_t robot = range.first; robot < range.last; ++robot) {
                call(robot);
            }
        }
    }
    static void note_callbacks(Program& program);
    static void set_callbacks(Program const& program);
    Controller& controller(std::uint32_t robot);

    ProgramImage image_;
    Callbacks callbacks_;
    std::optional<Callbacks> begun_with_;  // of a program for the SDK: those that its main() has set before it waited
    World& world_;
    RunServices& services_;
    std::vector<Controller> controllers_;                         // one for each robot of the world
    std::vector<RobotRange> ranges_;                              // of those that the program drives, ascending
    Controller system_;                                           // of the global step
    std::vector<std::unique_ptr<FunctionTimes>> function_times_;  // of the categories whose code takes time
    GuardedMemory user_data_;
    FiberPool fibers_;          // on which programs run
    std::int64_t step_us_ = 0;  // time of the step
    int most_loop_hz_ = 255;    // the highest main_loop_hz at which robots skip no ticks
    std::atomic<bool> has_waited_ = false;
    std::atomic<bool> is_restart_due_ = false;  // of some robot
    std::int64_t next_look_us_ = 0;             // at calls that do not return
    std::vector<bool> is_warned_;               // of them, for each category
    std::vector<std::span<std::byte>> own_variables_;
    mutable std::optional<std::string> why_not_saved_;  // once it has been asked for
    mutable std::string calls_back_;                    // function_that_calls_back(), then
    std::unique_ptr<RobotMemory> own_memory_;           // copies: of each robot, and of the global step
    struct MainArguments {
        std::string name;
        std::array<char*, 2> values{};  // the program's name, and NULL
    };
    std::vector<MainArguments> main_arguments_;  // of main(): one for all, or each robot's
};

}  // namespace pogosim
