// A whole run: a world, the stages that change it, and the recorder.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/fnv_1a.hpp"
#include "base/log.hpp"
#include "base/worker_pool.hpp"
#include "brain/host_brain.hpp"
#include "comms/ir_channel.hpp"
#include "config/scenario.hpp"
#include "config/user_parameters.hpp"
#include "device/link_edit.hpp"
#include "device/step_chips.hpp"
#include "firmware/observer.hpp"
#include "light/lighting.hpp"
#include "physics/free_places.hpp"
#include "physics/physics_engine.hpp"
#include "process/crash_handler.hpp"
#include "process/program_image.hpp"
#include "render/canvas.hpp"
#include "robot/controllers.hpp"
#include "robot/native_program.hpp"
#include "sim/flash_state.hpp"
#include "sim/heard_messages.hpp"
#include "sim/inspector.hpp"
#include "sim/link_changes.hpp"
#include "sim/observed_motions.hpp"
#include "sim/pictures.hpp"
#include "sim/recorder.hpp"
#include "sim/saved_columns.hpp"
#include "sim/snapshot_taker.hpp"
#include "sim/stage_clock.hpp"
#include "sim/state_file.hpp"
#include "sim/state_hash.hpp"
#include "sim/touches.hpp"
#include "view/messages.hpp"
#include "world/world.hpp"

namespace pogosim {

class Profile;
class WindowDriver;
struct SavedState;
struct FirmwareServices;

struct RunOptions {
    bool progress_bar = false;
    bool measure_stages = false;  // for benchmarks
    bool shares_nothing = false;  // the program: for benchmarks, where it is in one file with the simulator
    bool strict = false;          // unread parameters are an error
    Conversions conversions = Conversions::lenient;  // of parameters
    std::shared_ptr<Log> log{};                      // null: that of the process
    std::int64_t hash_period_steps = 0;              // a hash of the state in the log after so many steps each; 0: none
    std::string film{};                              // file of a film of the run; empty: none
    std::string profile{};                           // file of a profile of robots' firmware; empty: none
    std::uint32_t profile_robots = 1;                // how many robots are in it
    std::optional<int> gdb_port{};                   // at which gdb looks at a robot's firmware; absent: it does not
    std::optional<std::uint32_t> gdb_robot{};        // id; absent: the first one that runs firmware
    bool window = false;
    bool close_at_end = false;                      // else the window stays open when the simulated time is over
    std::string program_name{};                     // for the window's title
    std::string save_state{};                       // file that gets the state; empty: none
    std::optional<double> save_state_at_s{};        // absent: at the end of the run
    std::optional<double> save_state_every_s{};     // of wall-clock time, where it can be saved; absent: once
    std::shared_ptr<StateFile const> from_state{};  // from which the run goes on; null: it begins anew
    std::uint64_t inputs = kFnvBasis;               // InputHash of what was read for the scenario before
    std::optional<Restart> restarted{};             // by the user, in the window of the run before
    std::function<RestartCheck()> check_restart = [] { return RestartCheck{}; };  // see WindowSetup
};

/// The outcome of a part of a run.
struct Outcome {
    std::optional<UserFailure> failure{};   // of the program
    std::optional<std::string> shortage{};  // of memory, outside user code

    bool failed() const { return failure || shortage; }
};

class Simulation {
public:
    /// Builds the world. Throws ConfigError. A `program` without main() is none: then no category may need one.
    Simulation(ProgramImage program, Scenario scenario, RunOptions options);
    ~Simulation();

    Simulation(Simulation const&) = delete;
    Simulation& operator=(Simulation const&) = delete;

    /// From the first main() to the last callback: runs until the simulated time is over, the program or the user ends
    /// it, or user code fails. Errors of user code, and of pictures, are logged and set the exit code. Throws
    /// OutputError and, if strict, ConfigError at the end of a run in which a parameter was not read.
    ExitCode run();

    // The parts of a run, for tests and benchmarks: start() once, then steps, then finish().
    std::optional<UserFailure> start();
    std::optional<UserFailure> step();
    std::optional<UserFailure> end_programs();
    /// True if all pictures were written.
    bool finish();

    // For hosts, which step as they like: each part of the run inside attempt(), which lets nothing but OutputError and
    // ConfigError out, and conclude() at the end, or when an attempt has failed.

    Outcome attempt(std::function<std::optional<UserFailure>()> const& part);

    /// Completes the files, then logs what failed, if anything did, or what may be wrong with the program.
    ExitCode conclude(Outcome const& outcome);

    /// For a run that was made in vain: its end does not write the archive of flash memory.
    void leave_archive() { leaves_archive_ = true; }

    /// After conclude(): other runs may write the files of this one.
    void release_files() {
        recorder_.release();
        flash_state_.release();
    }

    /// Whether the simulated time is over, or the run was asked to end.
    bool is_over() const;

    std::uint32_t seed() const { return seed_; }

    /// The values under `parameters`.
    UserParameters& parameters() { return parameters_; }
    UserParameters const& parameters() const { return parameters_; }

    /// See state_hash.hpp.
    std::uint64_t hash() const { return state_hash(world_, controllers_, brains_); }

    /// The arrays that drive the robots of a category, `brain: host`. Null for any other category.
    HostBrain* host_brain(std::string_view category);

    /// Puts an object (index into World::objects) elsewhere, at rest. False for one without a body. The data file says
    /// that the run was touched. Throws ConfigError for a place in a wall or outside of the arena.
    bool set_pose(std::uint32_t object, Vec2 centre_mm, float heading_rad);

    /// Switches a robot (index into World::robots) off or on, see device/switched_off.hpp. The data file says that the
    /// run was touched.
    void set_alive(std::uint32_t robot, bool alive);

    /// Sets a lamp (index into World::lamps), and the light accordingly. The data file says that the run was touched.
    void set_lamp(std::size_t lamp, LampSetting const& setting);

    /// Makes a link, see device/link_edit.hpp, and returns its index. The data file says that the run was touched.
    /// Throws ConfigError.
    std::uint32_t add_link(NewLink const& link);

    /// Cuts links (indices into World::links) for good. The data file says that the run was touched. Throws ConfigError
    /// and cuts none, if there is none of an index.
    void cut_links(std::span<std::uint32_t const> links);

    /// The value of a user column from now on, in the rows of all objects or of one (index into World::objects), see
    /// HeldValues. Throws ConfigError.
    void set_column(std::optional<std::uint32_t> object, std::string const& name, double value);

    /// Gives the variables that the program has set to the value of `parameters.NAME` another one. False if there are
    /// none. Throws ConfigError for a value that the program would have been refused.
    bool set_parameter(std::string const& name, std::string const& yaml_value);

    /// Copies the state between two steps. Throws ConfigError for a run whose state cannot be copied.
    std::unique_ptr<SavedState> save();

    /// Why it cannot, but for a physics engine that cannot be copied; empty: it can.
    std::string why_not_saved() const;

    /// Goes on from a state of this run, as it did then. Arrays of the world stay where they are.
    void restore(SavedState const& saved);

    /// Before start(): throws ConfigError, which says why, if the run cannot go on from this state. Does not load it.
    void check_state(StateFile const& saved) const;

    /// The state for another process, to go on from it there, and what kind of run it is of. Throws ConfigError, see
    /// Brain::append_for_process().
    void append_for_process(StateWriter& state);
    StateFile kind_of_state() const;

    /// Why there is no such state in this run; and why not between these two steps. Empty: there is.
    std::string why_never_for_process() const;
    std::string why_not_now_for_process() const;

    /// Brings the file of a run that goes on up to date. Throws OutputError.
    void save_now();

    /// After run(): one line about a run without a window that reached its end after `wall_s` of wall-clock time. Empty
    /// for a run with a window, and for one that ended early, which was reported.
    std::string summary(double wall_s) const;

    /// After run(): how the user wants the run again; absent otherwise.
    std::optional<Restart> restart();

    /// Brings files up to date while the run is paused. Throws OutputError.
    void save_while_waiting();

    /// Takes pictures of the world between two steps. Made at the first call, so that it costs nothing without one.
    SnapshotTaker& snapshots();

    /// The world between two steps, as the configuration wants pictures, but for their size.
    Canvas picture(PictureSize size);

    /// Looks into single robots between two steps. Call it before start(), so that it sees every line that robots print
    /// and every row; a run without it does not keep any.
    Inspector& inspector();
    void stop_inspecting();

    /// From now on, pictures know which robots hear which.
    void keep_heard();

    /// What robots gave for the columns of the data file at its last save, if keep_columns() was called before start().
    void keep_columns() { recorder_.keep(&saved_columns_); }
    SavedColumns const& saved_columns() const { return saved_columns_; }

    /// What the metadata of a data file say of this run, see run_metadata() in recorder.cpp.
    std::vector<std::pair<std::string, std::string>> metadata() const { return recorder_.metadata(); }

    // Actions of the user in the window, between two steps. The data file says that the run was touched.

    /// Calls callback_robot_click of a robot, if it has one.
    std::optional<UserFailure> click(std::uint32_t robot);

    /// Moves an object (index into World::objects) to the free place nearest to `centre_mm`, see FreePlaces. It stands
    /// still there until its motors or other objects move it. False: it stays where it is.
    bool move_object(std::uint32_t object, Vec2 centre_mm);

    /// True from the first click that ran a callback, or the first move, on.
    bool is_touched() const { return touches_.any(); }

    /// Motions observed in the last step. From the first call on, the arrays stay in place and are always up to date.
    ObservedMotions const& observed_motions() const;

    /// The crash handler of this run's user code, for the owner of the process.
    CrashHandler& crash_handler() { return crash_handler_; }

    World const& world() const { return world_; }
    /// The world, which may be written to between two steps (world.hpp says what that does). The data file does not
    /// record it.
    World& world() { return world_; }
    IrChannel const& channel() const { return channel_; }
    Controllers const& controllers() const { return controllers_; }
    Brains const& brains() const { return brains_; }
    StageClock const& stages() const { return stages_; }
    std::int64_t step_count() const;  // steps of the whole run

private:
    /// While this exists, the thread works for this run.
    struct Thread {
        explicit Thread(Simulation& simulation)
            : logging(simulation.options_.log.get()),
              handled(simulation.crash_handler_),
              controllers(simulation.controllers_) {}
        LogScope logging;
        CrashHandlerScope handled;
        Controllers::Thread controllers;
    };

    std::optional<UserFailure> run_steps();
    void check_states();
    void check_saving();
    void go_on_from(StateFile const& saved);
    void save_state_if_due();
    bool is_state_due() const;
    void tell_of_late_state();
    /// Throws ConfigError without save_state_every_s.
    void go_on_unsaved(std::string const& reason);
    void save_state_at_end();
    void write_state();
    std::optional<UserFailure> call_brains(bool (Brain::*part)());
    void make_observer();
    FirmwareServices firmware_services();
    void fit_time_step();
    void open_window();
    /// Keeps from the start what pictures are to show, or the window may.
    void prepare_pictures();
    void deliver_messages();
    /// What pictures and the window have kept of the run so far, which goes on from another state.
    void forget_what_was_seen();
    void stay_open();
    FreePlaces const& free_places();
    /// An object was moved from outside.
    void note_move(std::uint32_t object);
    void report(UserFailure const& failure) const;
    void report_unread_parameters() const;
    std::string note_of_files() const;

    Scenario scenario_;
    RunOptions options_;
    std::uint32_t seed_;
    std::uint64_t inputs_;  // InputHash of the world
    World world_;
    UserParameters parameters_;
    CrashHandler crash_handler_;
    RunServices services_;
    Controllers controllers_;
    FlashState flash_state_;
    Lighting lighting_;
    IrChannel channel_;
    StepChips chips_;
    WorkerPool workers_;
    std::unique_ptr<FirmwareObserver> observer_;  // null: none looks on while robots run firmware
    Profile* profile_ = nullptr;                  // null: it is none
    Brains brains_;
    NativeProgram* program_ = nullptr;  // one of them
    std::unique_ptr<PhysicsEngine> physics_;
    BrokenLinks broken_links_;
    SavedColumns saved_columns_;
    Recorder recorder_;
    std::unique_ptr<Pictures> pictures_;  // null: none are wanted
    StageClock stages_;
    std::unique_ptr<SnapshotTaker> snapshots_;
    std::unique_ptr<HeardMessages> heard_;  // null: nothing shows it
    DeliveryLog heard_now_;                 // in this step, where there is no message log
    std::unique_ptr<Inspector> inspector_;
    std::optional<FreePlaces> free_places_;  // from the first move by hand on
    Touches touches_;
    mutable std::optional<ObservedMotions> observed_motions_;  // from the first look at them on
    std::unique_ptr<WindowDriver> window_;                     // null without a window
    RunIdentity identity_;                                     // as it began; empty: no state is saved
    std::unique_ptr<StateOutput> state_output_;                // null: no state is saved, or it was
    bool is_save_late_ = false;                                // the state is due, and a robot waits
    std::chrono::steady_clock::time_point saved_at_{};         // with save_state_every_s: when that was done last
    bool is_state_unwritten_ = false;                          // the last one could not be written, which was told
    std::string lost_state_{};                                 // why it could not be saved
    double began_s_ = 0.0;                                     // when this process took the run over
    bool leaves_archive_ = false;                              // of flash memory as it is
    bool is_complete_ = false;                                 // it came to its end, and all is written
};

}  // namespace pogosim
