#include "sim/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <typeinfo>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/input_hash.hpp"
#include "base/log.hpp"
#include "base/memory.hpp"
#include "base/rounded_time.hpp"
#include "config/places.hpp"
#include "device/clock.hpp"
#include "device/switched_off.hpp"
#include "firmware/firmware_brain.hpp"
#include "firmware/profile.hpp"
#include "process/backtrace.hpp"
#include "render/painter.hpp"
#include "robot/context.hpp"
#include "robot/program_checks.hpp"
#include "sim/build_world.hpp"
#include "sim/check_motion.hpp"
#include "sim/gdb_of_run.hpp"
#include "sim/lamps_of.hpp"
#include "sim/make_brains.hpp"
#include "sim/progress_bar.hpp"
#include "sim/window_driver.hpp"

namespace pogosim {

namespace {

std::uint32_t seed_of(Scenario const& scenario) {
    return scenario.seed ? *scenario.seed : static_cast<std::uint32_t>(std::random_device{}());
}

std::uint32_t thread_count(Scenario const& scenario, World const& world) {
    constexpr std::size_t kObjectsPerThread = 2000;
    static std::size_t const processors = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, kMostThreads);
    if (!scenario.threads) {
        return static_cast<std::uint32_t>(
            std::clamp<std::size_t>(world.objects.size() / kObjectsPerThread, 1, processors));
    }
    auto const threads = static_cast<std::uint32_t>(*scenario.threads);
    if (threads > processors) {
        log().warn(
            "{}: {} threads wait for each other on {}, which makes the run slower; 'auto' takes as many as "
            "are useful",
            place_of(scenario, Setting::threads), threads, counted(processors, "processor"));
    }
    return threads;
}

std::unique_ptr<PhysicsEngine> make_physics(Scenario const& scenario, World const& world, WorkerPool& workers) {
    std::string const& engine = scenario.physics_engine;
    if (std::string const reason = why_unfit(engine, world); !reason.empty()) {
        throw ConfigError(fmt::format("{}: {} {}", place_of(scenario, Setting::physics_engine), engine, reason));
    }
    auto const purpose = [&] { return fmt::format("the physics of {} bodies", world.bodies.size()); };
    try {
        return allocate_for(purpose, std::nullopt,
                            [&] { return make_physics_engine(engine, world, scenario.walls, workers); });
    } catch (ConfigError const& error) {
        throw ConfigError(fmt::format("{}: {}", place_of(scenario, Setting::arena_surface), error.what()));
    }
}

/// `inputs`: InputHash of what was read before, and then of this, too.
World make_world(Scenario const& scenario, std::uint32_t seed, std::uint64_t& inputs) {
    InputHash const read(inputs);
    World world = build_world(scenario, seed);
    inputs = read.value();
    return world;
}

Lighting make_lighting(Scenario const& scenario, World& world) {
    std::vector<LampSpec> const lamps = lamps_of(scenario, world);
    world.lamps = placed_lamps(scenario, world.arena);
    return {lamps, world};
}

}  // namespace

Simulation::Simulation(ProgramImage program, Scenario scenario, RunOptions options)
    : scenario_(std::move(scenario)),
      options_(std::move(options)),
      seed_(seed_of(scenario_)),
      inputs_(options_.inputs),
      world_(make_world(scenario_, seed_, inputs_)),
      parameters_(scenario_, options_.conversions),
      crash_handler_(code_of_robots(), reinterpret_cast<void const*>(program.main), scenario_.user_code_timeout_s),
      services_{.parameters = &parameters_, .seed = seed_, .data = {}, .stop_requested = false, .warned = {}},
      controllers_(std::move(program), world_, services_, seed_,
                   static_cast<std::size_t>(scenario_.robot_stack_kib) * 1024),
      flash_state_(scenario_, world_),
      lighting_(make_lighting(scenario_, world_)),
      chips_(world_),
      workers_(thread_count(scenario_, world_)),
      brains_(make_brains(world_, firmware_services())),
      physics_(make_physics(scenario_, world_, workers_)),
      recorder_(scenario_, world_, controllers_, brains_, services_.data, seed_),
      pictures_(Pictures::make(scenario_, world_, lighting_, saved_columns_, options_.film)),
      stages_(options_.measure_stages) {
    if (controllers_.image().main == nullptr) {
        check_needs_no_program(world_);
    }
    for (auto const& brain : brains_) {
        auto const* const firmware = dynamic_cast<FirmwareBrain const*>(brain.get());
        if (profile_ != nullptr && firmware != nullptr) {
            profile_->add(world_, firmware->category(), firmware->program());
        }
    }
    if (profile_ != nullptr) {
        profile_->check();
    }
    auto native = std::make_unique<NativeProgram>(controllers_, crash_handler_, workers_);
    program_ = native.get();
    brains_.insert(brains_.begin(), std::move(native));
    services_.edit.is_free = [this](Object const& object, Vec2 place_mm) {
        return free_places().is_free(object, place_mm);
    };
    services_.edit.update_light = [this] { lighting_.update(world_); };
    check_states();
}

Simulation::~Simulation() = default;

std::int64_t Simulation::step_count() const {
    return static_cast<std::int64_t>(std::ceil(scenario_.simulation_time_s / world_.time_step_s - kWholeTolerance));
}

SnapshotTaker& Simulation::snapshots() {
    if (!snapshots_) {
        snapshots_ = std::make_unique<SnapshotTaker>(world_, lighting_, saved_columns_);
    }
    return *snapshots_;
}

Canvas Simulation::picture(PictureSize size) {
    ViewOptions const& options = scenario_.view;
    Canvas canvas(size);
    Snapshot const snapshot = snapshots().take(parts_for(options));
    Painter().paint(canvas, camera_for(options, snapshot, size), snapshot, options);
    return canvas;
}

Inspector& Simulation::inspector() {
    if (!inspector_) {
        inspector_ = std::make_unique<Inspector>(world_, controllers_, brains_, physics_->touch_gaps());
        services_.printed_lines = &inspector_->lines();
        recorder_.show(&inspector_->rows());
    }
    return *inspector_;
}

void Simulation::stop_inspecting() {
    services_.printed_lines = nullptr;
    recorder_.show(nullptr);
    inspector_.reset();
}

bool Simulation::is_over() const {
    return world_.step >= step_count() || services_.stop_requested || interrupted() || (window_ && window_->is_over());
}

ExitCode Simulation::run() {
    Thread const thread(*this);
    ExitCode const code = conclude(attempt([this] { return run_steps(); }));
    if (window_ && code == ExitCode::done && !options_.close_at_end) {
        stay_open();
    }
    return code;
}

void Simulation::stay_open() {
    if (window_->is_over() || interrupted()) {
        return;
    }
    release_files();
    log().info("over at t = {:.4f} s; the window stays open until you close it (--close-at-end)", world_.time_s());
    window_->show_end();
}

Outcome Simulation::attempt(std::function<std::optional<UserFailure>()> const& part) {
    Thread const thread(*this);
    Outcome outcome;
    std::optional<UserFailure> const crash = call_simulator_code([&] {
        try {
            outcome.failure = part();
        } catch (OutOfMemory const& error) {
            outcome.shortage = error.what();
        } catch (std::bad_alloc const&) {
            outcome.shortage = kOutOfMemory;
        } catch (WorkerCrashed const&) {  // what it said ends the run
        }
    });
    if (crash) {
        outcome.failure = crash;
    } else if (!outcome.failed()) {
        outcome.failure = call_user_code([] {});  // a thread of the program may have failed in the meantime
    }
    return outcome;
}

ExitCode Simulation::conclude(Outcome const& outcome) {
    Thread const thread(*this);
    if (outcome.failed()) {
        flash_state_.release();
    }
    if (outcome.shortage) {
        std::string const message = fmt::format("t = {:.4f} s: {}", world_.time_s(), *outcome.shortage);
        try {
            finish();
        } catch (std::exception const&) {
            log().error("{}", message);
            throw;
        }
        throw OutOfMemory(message + note_of_files());
    }
    std::optional<UserFailure> const& failure = outcome.failure;
    if (failure) {
        // The message comes last, since it says what has become of the data file. When completing that crashes, because
        // memory is corrupted, the message of the first crash is printed.
        try {
            if (!failure->refused) {
                recorder_.open_without_rows();  // the file of an earlier run must not be mistaken for this one's
            }
            finish();
        } catch (std::exception const&) {
            report(*failure);
            throw;
        }
        report(*failure);
        call_user_code([this] { controllers_.print_unfinished_lines(); });
        return failure->code;
    }
    bool const all_pictures_written = finish();
    if (profile_ != nullptr) {
        profile_->write();
    }
    controllers_.warn_of_unreturned_calls_at_end();
    controllers_.tell_at_end(channel_.receptions());
    controllers_.warn_of_stacks();
    if (!scenario_.output.categories) {  // else a column may be that of a category without rows
        controllers_.tell_of_unset_columns(scenario_.output.fields);
    }
    report_unread_parameters();
    if (interrupted()) {
        log().warn("interrupted at t = {:.4f} s{}", world_.time_s(), note_of_files());
    }
    if (!lost_state_.empty()) {
        log().error("--save-state: '{}' was not written: {}", escaped(options_.save_state), lost_state_);
        return ExitCode::usage;
    }
    if (!all_pictures_written) {
        return ExitCode::usage;
    }
    is_complete_ = !interrupted();
    if (is_complete_ && !leaves_archive_) {
        flash_state_.save(world_);
    }
    return is_complete_ ? ExitCode::done : ExitCode::interrupted;
}

std::string Simulation::note_of_files() const {
    return recorder_.note() + flash_state_.note();
}

void Simulation::report_unread_parameters() const {
    UnreadParameters const unread = parameters_.unread();
    if (unread.all.empty()) {
        return;
    }
    constexpr auto what = "parameters never read by the program";
    if (options_.strict && !interrupted()) {
        throw ConfigError(fmt::format("{}: {} (--strict; the run itself is complete)", what, unread.all));
    }
    // Programs share configurations: a value that one of them does not read is usually meant for another.
    log().warn("{}: {}", what, unread.brief);
    log().debug("{}: {}", what, unread.all);
}

std::optional<UserFailure> Simulation::run_steps() {
    if (options_.window) {
        inspector();  // it sees all lines and rows
    }
    std::optional<UserFailure> failure = start();
    ProgressBar progress(step_count(), world_.time_step_s, options_.progress_bar);
    if (!failure && options_.window) {
        open_window();
    }
    while (!failure && !is_over()) {
        if (window_) {
            failure = window_->wait_for_step();
            if (failure || is_over()) {
                break;
            }
        }
        failure = step();
        if (!failure) {
            save_state_if_due();
        }
        if (options_.hash_period_steps > 0 && world_.step % options_.hash_period_steps == 0) {
            log().info("state after step {}: {:016x}", world_.step, hash());
        }
        if (window_) {
            window_->note_step();
        }
        progress.show(world_.step);
    }
    progress.finish(world_.step);
    if (!failure) {
        save_state_at_end();
    }
    return failure ? failure : end_programs();
}

std::optional<UserFailure> Simulation::end_programs() {
    Thread const thread(*this);
    return call_brains(&Brain::stop);
}

void Simulation::open_window() {
    try {
        WindowSetup setup = window_setup(scenario_, world_, options_.program_name);
        setup.columns = inspector().rows().columns();
        setup.values = RobotValues(world_, saved_columns_).names();
        setup.seed = seed_;
        setup.restored = options_.restarted ? options_.restarted->window : std::nullopt;
        if (setup.restored) {
            setup.speed_up = setup.restored->speed_up;
        }
        setup.check_restart = options_.check_restart;
        setup.hurry = [this](char const* what) { crash_handler_.hurry(what); };
        setup.scenery = snapshots().scenery();
        window_ = std::make_unique<WindowDriver>(*this, setup);
    } catch (std::runtime_error const& error) {
        log().warn(
            "the run has no window: {} (-g runs without one; pogosim doctor and docs/displays.md say what to do)",
            error.what());
        stop_inspecting();
    }
}

std::string Simulation::summary(double wall_s) const {
    if (!is_complete_ || window_) {
        return "";
    }
    auto const rows = recorder_.row_count();
    std::string const record =
        rows ? fmt::format("{} in '{}'", counted(*rows, "row"), escaped(scenario_.output.data_filename))
             : "no data file (enable_data_logging: false)";
    double const simulated_s = world_.time_s() - began_s_;
    double const times_real = simulated_s / wall_s;
    std::string const speed =
        times_real < 1000.0 ? fmt::format("{:.3g}", times_real) : fmt::format("{:.0f}", times_real);
    return fmt::format("{:.9g} s of {} simulated in {:.2f} s, {} x real time; {}", simulated_s,
                       counted(count_of_robots(world_), "robot"), wall_s, speed, record);
}

std::optional<Restart> Simulation::restart() {
    return window_ ? window_->restart() : std::nullopt;
}

void Simulation::save_while_waiting() {
    recorder_.save_if_due();
    flush_logs_if_due();
}

std::optional<UserFailure> Simulation::start() {
    Thread const thread(*this);
    log().debug("seed {}, {} with {} bytes of user data each, {} steps of {} s, physics engine {}, threads: {}", seed_,
                counted(world_.robots.size(), "robot"), controllers_.user_data_bytes(), step_count(),
                world_.time_step_s, physics_engine_behind(scenario_.physics_engine), workers_.size());
    lighting_.update(world_);
    services_.are_lines_hidden = options_.from_state != nullptr;
    bool const is_own = scenario_.robot_memory == RobotMemoryKind::automatic
                            ? controllers_.image().is_for_sdk
                            : scenario_.robot_memory == RobotMemoryKind::own;
    if (is_own && controllers_.image().main != nullptr) {
        controllers_.give_robots_own_memory();
    }
    if (auto failure = call_brains(&Brain::start)) {
        return failure;
    }
    if (controllers_.image().main != nullptr) {
        controllers_.warn_of_shared_variables();
        program_->share_steps(options_.shares_nothing);
    }
    fit_time_step();
    check_motion(scenario_, physics_->motion_limits(), world_.time_step_s);
    warn_of_ambiguous_rows(scenario_, world_);
    warn_of_rounded_speeds(scenario_, world_);
    check_saving();
    prepare_pictures();
    if (options_.from_state) {
        recorder_.go_on_behind(options_.from_state->rows);
    }
    if (auto failure = recorder_.open()) {
        return failure;
    }
    if (options_.from_state) {
        go_on_from(*options_.from_state);
        return std::nullopt;
    }
    auto failure = recorder_.record_if_due();
    if (pictures_) {
        pictures_->record_if_due();
    }
    return failure;
}

std::optional<UserFailure> Simulation::call_brains(bool (Brain::*part)()) {
    bool const all_go_on = std::ranges::all_of(brains_, [part](auto const& brain) { return (*brain.*part)(); });
    if (all_go_on) {
        return std::nullopt;
    }
    auto const failed = std::ranges::find_if(brains_, [](auto const& brain) { return brain->failure().has_value(); });
    return failed == brains_.end() ? std::nullopt : (*failed)->failure();
}

/// A profile counts time, whatever the configuration says.
void Simulation::make_observer() {
    if (options_.gdb_port) {
        observer_ = gdb_of_run(world_, {*options_.gdb_port, options_.gdb_robot, services_.stop_requested});
    }
    if (options_.profile.empty()) {
        return;
    }
    auto profile = std::make_unique<Profile>(options_.profile, options_.profile_robots);
    profile_ = profile.get();
    observer_ = std::move(profile);
    for (Category& category : world_.categories) {
        if (category.spec.robot) {
            category.spec.robot->cpu_time = CpuTime::counted;
        }
    }
}

FirmwareServices Simulation::firmware_services() {
    make_observer();
    return {.seed = seed_,
            .timeout_s = scenario_.user_code_timeout_s,
            .workers = &workers_,
            .observer = observer_.get(),
            .print = [this](std::uint32_t robot, std::string_view line) { services_.print_line(world_, robot, line); },
            .is_interrupted = interrupted};
}

HostBrain* Simulation::host_brain(std::string_view category) {
    auto const named = [&](std::unique_ptr<Brain> const& pointer) {
        Brain const& brain = *pointer;
        return typeid(brain) == typeid(HostBrain) && static_cast<HostBrain const&>(brain).category() == category;
    };
    auto const found = std::ranges::find_if(brains_, named);
    return found == brains_.end() ? nullptr : static_cast<HostBrain*>(found->get());
}

std::optional<UserFailure> Simulation::step() {
    Thread const thread(*this);
    stages_.begin_step();
    lighting_.update(world_);
    stages_.end(Stage::light);
    for (std::uint32_t const robot : chips_.begin_step(world_, time_us(world_))) {
        pogosim::set_alive(world_, robot, false);  // its battery is empty
    }
    if (auto failure = call_brains(&Brain::run_step)) {
        return failure;
    }
    hold_switched_off(world_);
    stages_.end(Stage::robots);
    deliver_messages();
    stages_.end(Stage::messages);
    broken_links_.note(world_);
    physics_->advance(world_);
    broken_links_.tell(world_);
    if (observed_motions_) {
        observed_motions_->update(world_);
    }
    stages_.end(Stage::physics);
    ++world_.step;
    auto failure = recorder_.record_if_due();
    if (pictures_) {
        pictures_->record_if_due();
    }
    recorder_.save_if_due();
    flush_logs_if_due();
    stages_.end(Stage::record);
    return failure;
}

void Simulation::deliver_messages() {
    DeliveryLog* const logged = recorder_.deliveries();
    DeliveryLog* const log = logged == nullptr && heard_ ? &heard_now_ : logged;
    channel_.deliver(world_, log, &workers_);
    if (heard_) {
        heard_->note(world_, *log);
    }
}

void Simulation::prepare_pictures() {
    if (options_.window || needs_columns(scenario_.view)) {
        keep_columns();
    }
    if (scenario_.view.heard) {
        keep_heard();
    }
}

void Simulation::keep_heard() {
    if (heard_) {
        return;
    }
    heard_ = std::make_unique<HeardMessages>();
    if (pictures_) {
        pictures_->show_heard(heard_.get());
    }
    snapshots().show_heard(heard_.get());
}

std::optional<UserFailure> Simulation::click(std::uint32_t robot) {
    Thread const thread(*this);
    bool has_callback = false;
    auto failure = call_user_code([&] { has_callback = controllers_.click(robot); });
    if (has_callback || failure) {
        touches_.add(Touch::click, world_.time_s());
    }
    return failure;
}

ObservedMotions const& Simulation::observed_motions() const {
    if (!observed_motions_) {
        observed_motions_.emplace(world_);
    }
    return *observed_motions_;
}

void Simulation::note_move(std::uint32_t object) {
    Object const& moved = world_.objects[object];
    if (observed_motions_) {
        observed_motions_->update(world_, moved);
    }
    touches_.add_move(object, world_.time_s());
}

FreePlaces const& Simulation::free_places() {
    if (!free_places_) {
        free_places_.emplace(world_);
    }
    return *free_places_;
}

bool Simulation::move_object(std::uint32_t object, Vec2 centre_mm) {
    Object const& moved = world_.objects[object];
    Vec2 const place_mm = free_places().nearest(moved, centre_mm);
    if (place_mm == pogosim::centre_mm(world_, moved)) {
        return false;
    }
    pogosim::set_pose(world_, moved, place_mm, world_.bodies.heading_rad[moved.body]);
    note_move(object);
    return true;
}

bool Simulation::set_pose(std::uint32_t object, Vec2 centre_mm, float heading_rad) {
    Object const& moved = world_.objects[object];
    if (moved.body == kNone) {
        return false;
    }
    auto const is_possible = [](float number) { return std::abs(number) <= kMaxLength; };
    if (!is_possible(centre_mm.x) || !is_possible(centre_mm.y) || !is_possible(heading_rad)) {
        throw ConfigError(fmt::format("expected finite numbers (mm, rad) up to {:g}, found ({:g}, {:g}), heading {:g}",
                                      kMaxLength, centre_mm.x, centre_mm.y, heading_rad));
    }
    if (!services_.edit.set_pose(world_, moved, centre_mm, heading_rad)) {
        throw ConfigError(
            fmt::format("({:g}, {:g}) mm is inside a wall or outside the arena; an object cannot be placed there",
                        centre_mm.x, centre_mm.y));
    }
    note_move(object);
    return true;
}

void Simulation::set_alive(std::uint32_t robot, bool alive) {
    Thread const thread(*this);
    pogosim::set_alive(world_, robot, alive);
    touches_.add(Touch::alive, world_.time_s());
}

void Simulation::set_lamp(std::size_t lamp, LampSetting const& setting) {
    services_.edit.set_lamp(world_, lamp, setting);
    services_.edit.settle_light();
    touches_.add(Touch::lamp, world_.time_s());
}

std::uint32_t Simulation::add_link(NewLink const& link) {
    std::uint32_t const index = pogosim::add_link(world_, link);
    touches_.add(Touch::link, world_.time_s());
    return index;
}

void Simulation::cut_links(std::span<std::uint32_t const> links) {
    for (std::uint32_t const link : links) {
        link_at(world_, link);
    }
    for (std::uint32_t const link : links) {
        cut_link(world_, link);
    }
    if (!links.empty()) {
        touches_.add(Touch::link, world_.time_s());
    }
}

void Simulation::set_column(std::optional<std::uint32_t> object, std::string const& name, double value) {
    if (!services_.data.is_declared) {
        throw ConfigError(fmt::format("column '{}': the run records no rows (enable_data_logging: false)", name));
    }
    services_.data.hold(world_.objects.size(), object, name, value);
    touches_.add(Touch::column, world_.time_s());
}

bool Simulation::set_parameter(std::string const& name, std::string const& yaml_value) {
    Thread const thread(*this);
    UserParameters source = parameters_.with(name, yaml_value);
    bool has_variable = false;
    for (BoundVariable const& bound : services_.bound_variables) {
        if (bound.name == name) {
            controllers_.set_for_all(bound, source);
            has_variable = true;
        }
    }
    if (has_variable) {
        touches_.add(Touch::parameter, world_.time_s());
    }
    return has_variable;
}

void Simulation::save_now() {
    Thread const thread(*this);
    recorder_.save_now();
}

bool Simulation::finish() {
    Thread const thread(*this);
    if (std::string const touched = touches_.text(); !touched.empty()) {
        recorder_.add_metadata("touched", touched);
    }
    if (began_s_ > 0.0) {
        recorder_.add_metadata("continued_from_s", fmt::format("{}", rounded_to_ns(began_s_)));
    }
    recorder_.close();  // first: the data matter most
    return !pictures_ || pictures_->finish();
}

void Simulation::fit_time_step() {
    int hz = controllers_.highest_loop_hz();
    for (auto const& brain : brains_) {
        hz = std::max(hz, brain->highest_loop_hz());
    }
    if (skips_ticks(hz, world_.time_step_s)) {
        double const tick_s = seconds_between_ticks(hz);
        log().warn("time_step reduced from {} s to {} s, so that no ticks are skipped (main_loop_hz: {})",
                   world_.time_step_s, tick_s, hz);
        world_.time_step_s = tick_s;
    }
    controllers_.watch_loop_rates();
}

void Simulation::report(UserFailure const& failure) const {
    std::string const source = place_in_source(controllers_.image(), failure.place);
    std::string const place = !failure.where.empty()    ? failure.where
                              : failure.in_other_thread ? "a thread that it started"
                                                        : current_place();
    std::string const where =
        fmt::format("{}, t = {:.4f} s{}", place, world_.time_s(), source.empty() ? "" : ", " + source);
    if (failure.refused) {
        log().error("{} (called from {}){}", failure.what, where, note_of_files());
        return;
    }
    if (failure.code == ExitCode::interrupted) {
        log().warn("the run was interrupted in {}: {}{}", where, failure.what, note_of_files());
        return;
    }
    bool const failed = failure.code != ExitCode::done;  // else it called exit(0)
    // C++ compilers let a function without its return run on into the next one; only a real main() is excused.
    bool const may_lack_return = failure.code == ExitCode::user_program && !failure.in_other_thread &&
                                 !failure.too_long && failure.where.empty() && context.phase == Phase::main &&
                                 !controllers_.image().is_for_sdk;
    log().log(failed ? spdlog::level::err : spdlog::level::warn, "the user program {} in {}: {}{}{}",
              failed ? "failed" : "ended", where, failure.what,
              may_lack_return ? " (in C++, main() must end with 'return 0;')" : "", note_of_files());
}

}  // namespace pogosim
