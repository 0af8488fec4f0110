#include "firmware/firmware_brain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <utility>

#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/log.hpp"
#include "device/clock.hpp"
#include "device/motors.hpp"
#include "device/sensing.hpp"
#include "device/set_up.hpp"
#include "firmware/firmware_call.hpp"
#include "firmware/firmware_robot.hpp"

namespace pogosim {

namespace {

constexpr std::uint32_t kLeastRobots = 8;  // of a part that one worker takes
constexpr std::size_t kReturnAddress = 1;  // register ra
constexpr std::size_t kStackPointer = 2;   // register sp

/// An unsigned variable of a robot, at an address that the firmware says.
template <std::uint32_t Bytes>
std::uint32_t variable(Memory const& memory, std::uint32_t address) {
    std::byte const* const place = memory.readable<Bytes>(address);
    return place == nullptr ? 0 : read_little_endian<Bytes>(place);
}

/// A robot's firmware cannot go on.
struct Failed : std::exception {
    UserFailure failure;

    explicit Failed(UserFailure its_failure) : failure(std::move(its_failure)) {}
    char const* what() const noexcept override { return failure.what.c_str(); }
};

/// Whether a function of the library is at an address.
bool is_call_of_library(Code const& code, std::uint32_t address) {
    Step const* const step = code.step_at(address);
    return step != nullptr && step->operation == Operation::intercepted && intercepted_number(code, address) >= 0;
}

bool same_slip(Slip const& a, Slip const& b) {
    return a.function == b.function && a.argument == b.argument && a.outcome == b.outcome;
}

}  // namespace

FirmwareBrain::FirmwareBrain(World& world, std::uint32_t category, std::shared_ptr<FirmwareProgram const> program,
                             FirmwareServices services)
    : world_(world),
      category_(category),
      range_(robots_of(world, category)),
      spec_(*world.categories[category].spec.robot),
      program_(std::move(program)),
      services_(std::move(services)) {
    robots_.reserve(range_.size());
    for (std::uint32_t robot = range_.first; robot < range_.last; ++robot) {
        robots_.push_back(new_robot(robot));
    }
}

FirmwareRobot FirmwareBrain::new_robot(std::uint32_t robot) const {
    FirmwareRobot self(program_->firmware.image);
    self.core.pc = program_->firmware.entry;
    self.is_starting = program_->loop_timer.has_value();
    MemoryImage const& image = *program_->firmware.image;
    self.core.x[kStackPointer] = image.address + static_cast<std::uint32_t>(image.bytes.size());
    self.seeds = random_seeds(services_.seed, robot, id_on_air(world_.robots.id[robot]));
    self.random = random_of_program(services_.seed, robot);
    return self;
}

bool FirmwareBrain::start() {
    step_us_ = time_us(world_);
    return run_all();
}

bool FirmwareBrain::run_step() {
    step_us_ = time_us(world_);
    return run_all();
}

/// A robot whose tick does not end looks as if it had little to do.
void FirmwareBrain::warn_of_endless_ticks() const {
    constexpr std::int64_t long_us = 1'000'000;
    constexpr std::int64_t longest_sleep_us = 10'000'000;
    constexpr std::int64_t soon_us = 20'000;
    constexpr double s_per_us = 1e-6;
    std::uint32_t count = 0;
    std::string first;
    for (std::uint32_t robot = range_.first; robot < range_.last; ++robot) {
        FirmwareRobot const& self = this->robot(robot);
        std::int64_t const since_us = time_us(world_) - self.went_on_us;
        bool const is_in_tick =
            program_->loop_timer && is_alive(world_, robot) && !self.is_ending_tick && !self.has_ended;
        bool const sleeps = world_.devices.clock_us[robot] - time_us(world_) > soon_us;
        if (is_in_tick && since_us > (sleeps ? longest_sleep_us : long_us) && count++ == 0) {
            first = fmt::format("robot #{} of category '{}' has been in {} for {:.1f} s, in {}, and {} has not ended",
                                world_.robots.id[robot], world_.categories[category_].name,
                                self.is_starting ? "user_init" : fmt::format("tick {}", world_.devices.ticks[robot]),
                                s_per_us * static_cast<double>(since_us), place_of(self),
                                self.is_starting ? "that" : "the tick");
        }
    }
    if (count > 0) {
        log().warn("{}{}", first, count > 1 ? fmt::format(" ({} such robots)", count) : "");
    }
}

bool FirmwareBrain::stop() {
    warn_of_endless_ticks();
    for (std::uint32_t robot = range_.first; robot < range_.last; ++robot) {
        FirmwareRobot& self = robots_[robot - range_.first];
        if (!self.printed.empty()) {
            services_.print(robot, std::exchange(self.printed, {}));
        }
    }
    return true;
}

FirmwareVariables const& FirmwareBrain::variables() const {
    if (!variables_) {
        variables_.emplace(*program_);
    }
    return *variables_;
}

/// Several categories may have the same columns.
void FirmwareBrain::declare_columns(std::vector<ColumnSpec>& columns) {
    for (std::string const& name : std::get<FirmwareSpec>(spec_.brain).columns.value_or(std::vector<std::string>())) {
        FirmwareVariable const variable = variables().find(name);
        ColumnType const type = column_type_of(*variable.type);
        auto const found = std::ranges::find(columns, name, &ColumnSpec::name);
        if (found != columns.end() && found->type != type) {
            throw ConfigError(fmt::format("{}: column '{}': another column of this name has another type",
                                          escaped(program_->file), escaped(name)));
        }
        columns_.push_back({static_cast<std::size_t>(found - columns.begin()), variable});
        if (found == columns.end()) {
            columns.push_back({name, type});
        }
    }
}

void FirmwareBrain::fill_row(std::uint32_t robot, std::span<CellValue> cells) const {
    if (!range_.contains(robot)) {
        return;
    }
    for (Column const& column : columns_) {
        cells[column.index] = value_of(column.variable, this->robot(robot).memory);
    }
}

/// What the last tick has taken, without the time of library functions. There are no ticks without a main loop.
std::string FirmwareBrain::load_text(FirmwareRobot const& self) const {
    if (!program_->loop_timer) {
        return "no main loop";
    }
    ProcessorSpec const& processor = spec_.model.processor;
    double const taken_us = processor.us_of(static_cast<double>(self.tick_cycles));
    int const hz = loop_hz_of(self);
    constexpr double us_per_s = 1e6;
    std::string const cycles = fmt::format("{} cycles in the last tick", self.tick_cycles);
    double const percent = 100.0 * taken_us * hz / us_per_s;
    return hz == 0 ? cycles : fmt::format("{:.{}f} %, {}", percent, percent < 9.95 ? 1 : 0, cycles);
}

/// main_loop_hz of a robot; the usual value if the compiler has left that out because it never changes.
int FirmwareBrain::loop_hz_of(FirmwareRobot const& self) const {
    constexpr int usual_hz = 60;
    return written_loop_hz(self).value_or(usual_hz);
}

/// The same; nothing if the compiler has left it out.
std::optional<int> FirmwareBrain::written_loop_hz(FirmwareRobot const& self) const {
    return program_->loop_hz ? std::optional<int>(variable<1>(self.memory, *program_->loop_hz)) : std::nullopt;
}

NamedTexts FirmwareBrain::texts_of(std::uint32_t robot) const {
    if (!range_.contains(robot)) {
        return {};
    }
    FirmwareRobot const& self = this->robot(robot);
    NamedTexts texts{{"(processor load)", load_text(self)}};
    std::ranges::move(variables().texts(self.memory), std::back_inserter(texts));
    return texts;
}

int FirmwareBrain::highest_loop_hz() const {
    int highest = 0;
    for (FirmwareRobot const& self : robots_) {
        highest = std::max(highest, written_loop_hz(self).value_or(0));
    }
    return highest;
}

bool FirmwareBrain::run_all() {
    if (range_.size() == 0) {
        return true;
    }
    WorkerPool& workers = *services_.workers;
    std::uint32_t const least = services_.observer != nullptr ? range_.size() : kLeastRobots;
    parts_.resize(workers.range_count(range_.size(), least));
    workers.run_ranges(range_.size(), least, [this](WorkRange range) { run_part(range); });
    for (Part& part : parts_) {
        join(part);
        if (part.failure) {
            failure_ = part.failure;
            return false;
        }
    }
    return true;
}

void FirmwareBrain::run_part(WorkRange range) {
    Part& part = parts_[range.part];
    part.out.clear();
    part.failure.reset();
    for (std::uint32_t i = range.first; i < range.last && !part.failure; ++i) {
        std::uint32_t const robot = range_.first + i;
        if (is_observed(robot)) {
            services_.observer->look(robot, robots_[i].core, robots_[i].memory, program_->firmware.code);
        }
        if (world_.devices.clock_us[robot] <= step_us_) {
            run_robot(robot, part);
        }
    }
}

/// Its processor is reset. What it has drawn as seeds, and printed, stays so.
void FirmwareBrain::restart(std::uint32_t robot) {
    FirmwareRobot& self = robots_[robot - range_.first];
    FirmwareRobot anew = new_robot(robot);
    anew.seeds = self.seeds;
    anew.printed = std::move(self.printed);
    self = std::move(anew);
    reset_devices(world_, robot, step_us_);
    self.went_on_us = step_us_;
    if (is_observed(robot)) {
        services_.observer->note_start(robot);
    }
}

void FirmwareBrain::run_robot(std::uint32_t robot, Part& part) {
    FirmwareRobot& self = robots_[robot - range_.first];
    bool const restarts = self.is_restart_due;
    if (restarts) {
        restart(robot);
    }
    if (!std::exchange(self.was_cut_off, false)) {
        measure_at_tick(world_, robot);
    }
    if (!program_->loop_timer) {
        self.went_on_us = world_.devices.clock_us[robot];
    }
    FirmwareCall call{.world = world_,
                      .robot = robot,
                      .self = self,
                      .program = *program_,
                      .out = part.out,
                      .function = {},
                      .times = spec_.model.processor.calls};
    try {
        go_on(call);
        if (restarts && !self.is_starting && !self.has_ended && !is_ahead(call)) {
            go_on(call);  // its first tick
        }
    } catch (RefusedCall const& refused) {
        part.failure = failure_of(call, refused.what());
        part.failure->code = ExitCode::usage;
        part.failure->refused = true;
    } catch (WrongAddress const& wrong) {
        part.failure = failure_of(call, text_of(wrong));
    } catch (Failed const& failed) {
        part.failure = failed.failure;
    }
    if (part.failure && is_observed(robot)) {
        services_.observer->show_failure(robot, self.core, self.memory, program_->firmware.code);
    }
    if (program_->ticks) {
        world_.devices.ticks[robot] = variable<4>(self.memory, *program_->ticks);
    }
    if (self.has_ended) {
        world_.devices.clock_us[robot] = kIdle;
    }
    drive(world_, robot);
}

/// Whether a robot has to wait for the time of the run.
bool FirmwareBrain::is_ahead(FirmwareCall const& call) const {
    return call.clock_us() > step_us_;
}

/// Cycles that a robot may run before it has to be looked at. `used`: those since it waited.
std::uint64_t FirmwareBrain::budget(FirmwareCall const& call, std::uint64_t used) const {
    constexpr std::uint64_t most = 20'000'000;  // after which the user may want the run to end
    FirmwareRobot const& self = call.self;
    double const cycle_us = spec_.model.processor.us_of(1.0);
    if (is_counted() && !self.runs_ahead()) {
        double const left_us = static_cast<double>(step_us_ + 1 - call.clock_us()) - self.rest_us;
        return static_cast<std::uint64_t>(std::clamp(std::ceil(left_us / cycle_us), 1.0, static_cast<double>(most)));
    }
    std::uint64_t const limit = cycle_limit();
    return limit == 0 ? most : std::min(most, limit - std::min(limit, used));
}

/// Cycles after which code that never waits ends the run; 0: it may run for ever.
std::uint64_t FirmwareBrain::cycle_limit() const {
    constexpr double us_per_s = 1e6;
    constexpr double most = 1e18;
    double const cycles = services_.timeout_s * us_per_s / spec_.model.processor.us_of(1.0);
    return services_.timeout_s == 0.0 ? 0 : static_cast<std::uint64_t>(std::clamp(cycles, 1.0, most));
}

/// A robot has used its budget. Throws Failed if that was its last one.
void FirmwareBrain::check_time(FirmwareCall const& call, std::uint64_t used) const {
    bool const is_timed = is_counted() && !call.self.runs_ahead();
    std::uint64_t const limit = cycle_limit();
    if (!is_timed && limit > 0 && used >= limit) {
        throw Failed(
            failure_of(call, fmt::format("it has run for {} s on the robot's processor {}", services_.timeout_s,
                                         call.self.is_starting ? "before its main loop" : "without waiting")));
    }
    if (services_.is_interrupted()) {
        UserFailure failure = failure_of(call, "it was running");
        failure.code = ExitCode::interrupted;
        throw Failed(failure);
    }
}

/// The clock of a robot whose code takes time goes on by that of its cycles, and of what its last call has taken.
void FirmwareBrain::count_time(FirmwareCall& call) const {
    FirmwareRobot& self = call.self;
    if (is_counted()) {
        auto const cycles = static_cast<double>(self.core.cycles - self.timed_cycles);
        take_time(world_, call.robot, spec_.model.processor.us_of(cycles) + call.time_us, self.rest_us);
    }
    self.timed_cycles = self.core.cycles;
    call.time_us = 0.0;
}

bool FirmwareBrain::is_observed(std::uint32_t robot) const {
    return services_.observer != nullptr && services_.observer->observes(robot);
}

Stop FirmwareBrain::run_core(FirmwareCall& call, std::uint64_t most_cycles) const {
    FirmwareRobot& self = call.self;
    Code const& code = program_->firmware.code;
    if (!is_observed(call.robot)) [[likely]] {
        return run(self.core, self.memory, code, most_cycles);
    }
    double const clock_us = static_cast<double>(call.clock_us()) + self.rest_us;
    return services_.observer->run(call.robot, self.core, self.memory, code, most_cycles, clock_us);
}

/// Runs a robot until it waits.
void FirmwareBrain::go_on(FirmwareCall& call) const {
    FirmwareRobot& self = call.self;
    Code const& code = program_->firmware.code;
    std::uint64_t const waited_cycles = self.core.cycles;
    for (bool goes_on = true; goes_on;) {
        Stop const stop = run_core(call, budget(call, self.core.cycles - waited_cycles));
        count_time(call);
        if (stop.reason == StopReason::budget_used) {
            check_time(call, self.core.cycles - waited_cycles);
            goes_on = !is_counted() || self.runs_ahead() || !is_ahead(call);
            self.was_cut_off = !goes_on;
        } else if (stop.reason == StopReason::intercepted) {
            std::int32_t const number = intercepted_number(code, stop.pc);
            self.has_ended = number == kEndlessLoop;
            goes_on = number != kEndlessLoop && make_call(call, library_functions()[static_cast<std::size_t>(number)]);
        } else if (stop.reason == StopReason::wait_for_interrupt) {
            self.has_ended = true;
            goes_on = false;
        } else {
            throw Failed(failure_of(call, text_of(stop, self, program_->firmware)));
        }
    }
}

/// A tick of the main loop begins. False: it does so in another step.
bool FirmwareBrain::begin_tick(FirmwareCall& call) const {
    FirmwareRobot& self = call.self;
    if (self.is_starting) {
        // pogobot_start() resets it, too, before user_init.
        self.is_starting = ++self.timer_resets < 2;
        return self.is_starting;
    }
    if (std::exchange(self.is_drift_due, false)) {  // its last one has not slept
        drift_clock(world_, call.robot, self.went_on_us);
        if (is_ahead(call)) {
            return false;
        }
    }
    if (!is_counted() && self.tick_step == world_.step) {
        return false;  // its last one took no time
    }
    if (!is_counted() && written_loop_hz(self) == 0) {
        call.clock_us() = step_us_;  // without a sleep the clock follows the steps
    }
    self.tick_cycles = self.core.cycles - self.tick_began_cycles;
    self.tick_began_cycles = self.core.cycles;
    self.tick_step = world_.step;
    self.calls = 0;
    self.went_on_us = call.clock_us();
    self.is_drift_due = true;
    if (is_observed(call.robot)) {
        services_.observer->note_tick(call.robot, call.ticks(), loop_hz_of(self),
                                      static_cast<double>(call.clock_us()) + self.rest_us);
    }
    return true;
}

/// Notes a call that may be in a loop that waits: where code takes no time, and before the main loop, when the robot
/// runs ahead of the world. False: the robot waits before it.
bool FirmwareBrain::note_call(FirmwareCall& call, LibraryFunction const& function) const {
    FirmwareRobot& self = call.self;
    bool const may_wait = !is_counted() || self.is_starting;
    bool const is_noted = function.noted != Noted::at_line_end || call.argument(0) == '\n';
    if (!may_wait || !is_noted || std::exchange(self.has_noted_call, false) || ++self.calls <= kFreeCalls) {
        return true;
    }
    call.clock_us() += is_counted() ? 0 : kCallUs;
    self.has_noted_call = is_ahead(call) && !(self.is_starting && function.noted == Noted::as_clock);
    return !self.has_noted_call;
}

/// Throws Failed if the stack has grown into the variables, above which it was in the beginning.
void FirmwareBrain::check_stack(FirmwareCall& call) const {
    FirmwareRobot& self = call.self;
    std::uint32_t const end = program_->firmware.variables_end;
    bool const is_above = self.core.x[kStackPointer] >= end;
    if (!std::exchange(self.has_called, true)) {
        self.is_stack_above = is_above;
    }
    if (self.is_stack_above && !is_above) {
        throw Failed(failure_of(call, fmt::format("its stack has grown down to 0x{:08x}, into its variables, which end "
                                                  "at 0x{:08x}",
                                                  self.core.x[kStackPointer], end)));
    }
}

/// False: the robot waits, before the call or after it.
bool FirmwareBrain::make_call(FirmwareCall& call, LibraryFunction const& function) const {
    FirmwareRobot& self = call.self;
    bool const is_of_loop = program_->loop_timer && call.argument(0) == *program_->loop_timer;
    bool const begins_tick = is_of_loop && function.use == StopwatchUse::resets;
    self.is_ending_tick = self.is_ending_tick && !begins_tick;
    if ((is_ahead(call) && !self.runs_ahead()) || !note_call(call, function) || (begins_tick && !begin_tick(call))) {
        return false;
    }
    call.function = function.name;
    check_stack(call);
    CallOutcome const outcome = function.call(call);
    if (outcome == CallOutcome::repeats) {
        return self.is_starting && !self.is_restart_due;
    }
    call.time_us += static_cast<double>(call.times.*function.time);
    if (is_observed(call.robot)) {
        services_.observer->note_call(call.robot, self.core.pc, call.time_us);
    }
    self.core.pc = self.core.x[kReturnAddress];
    call.function = {};
    count_time(call);
    bool const ends_tick = std::exchange(self.ends_tick, is_of_loop && function.use == StopwatchUse::reads);
    if (outcome == CallOutcome::sleeps) {
        if (ends_tick || !program_->loop_timer) {
            drift_clock(world_, call.robot, self.went_on_us);
            self.is_drift_due = false;
        }
        // After the sleep of the main loop, the rest of the tick goes on; in user_init, all does.
        self.is_ending_tick = ends_tick && !self.is_starting;
        return self.runs_ahead() || !is_ahead(call);
    }
    self.has_ended = outcome == CallOutcome::ends;
    bool const is_timed = is_counted() && !self.runs_ahead();
    return !self.has_ended && !(is_timed && is_ahead(call));
}

void FirmwareBrain::join(Part& part) {
    world_.air.append(part.out.air);
    for (FirmwareOutbox::Said const& said : part.out.said) {
        if (said.slip.outcome.empty()) {
            services_.print(said.robot, said.text);
        } else if (std::ranges::none_of(warned_, [&](Slip const& slip) { return same_slip(slip, said.slip); })) {
            warned_.push_back(said.slip);
            log().warn("robot #{} of category '{}', tick {}, t = {:.4f} s: {}", world_.robots.id[said.robot],
                       world_.categories[world_.robots.category[said.robot]].name, said.ticks, world_.time_s(),
                       said.text);
        }
    }
}

/// Where a robot is: a call of the library is where its caller is.
std::string FirmwareBrain::place_of(FirmwareRobot const& self) const {
    bool const is_in_call = is_call_of_library(program_->firmware.code, self.core.pc) || is_without_code(self);
    return place_in_firmware(*program_, is_in_call ? self.core.x[kReturnAddress] - 4 : self.core.pc);
}

UserFailure FirmwareBrain::failure_of(FirmwareCall const& call, std::string what) const {
    return {
        .what = std::move(what),
        .where = fmt::format("{} of robot #{} of category '{}'{}", place_of(call.self), world_.robots.id[call.robot],
                             world_.categories[world_.robots.category[call.robot]].name,
                             program_->ticks ? fmt::format(", tick {}", call.ticks()) : "")};
}

void FirmwareBrain::append_state(std::vector<std::byte>& bytes) const {
    for (FirmwareRobot const& self : robots_) {
        save_robot(self, bytes);
    }
}

void FirmwareBrain::take_state(std::span<std::byte const>& bytes) {
    for (std::uint32_t robot = range_.first; robot < range_.last; ++robot) {
        FirmwareRobot& self = robots_[robot - range_.first];
        self = new_robot(robot);
        restore_robot(self, bytes);
    }
}

}  // namespace pogosim
