#include "robot/controllers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <new>
#include <string_view>
#include <utility>

#include "base/counted.hpp"
#include "base/environment.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "device/clock.hpp"
#include "device/flash.hpp"
#include "device/motors.hpp"
#include "device/sensing.hpp"
#include "device/switched_off.hpp"
#include "process/crash_handler.hpp"
#include "process/crash_message.hpp"
#include "robot/assert_controllers.hpp"
#include "robot/call_checks.hpp"
#include "robot/program_checks.hpp"
#include "robot/robot_floating_point.hpp"
#include "robot/shared_variables_check.hpp"

extern "C" {
// `mydata` of programs with DECLARE_USERDATA, a pointer to their own type of user data.
__attribute__((visibility("default"))) POGO_PER_ROBOT void* pogosim_mydata = nullptr;

POGO_PER_ROBOT void (*callback_global_setup)() = nullptr;
POGO_PER_ROBOT void (*callback_create_data_schema)() = nullptr;
POGO_PER_ROBOT void (*callback_export_data)() = nullptr;
POGO_PER_ROBOT void (*callback_global_step)() = nullptr;
POGO_PER_ROBOT void (*callback_robot_end)() = nullptr;
POGO_PER_ROBOT void (*callback_robot_click)() = nullptr;
}

namespace pogosim {

namespace {

constexpr std::size_t kUserDataAlignment = 64;  // a cache line; more than any C type asks for
constexpr char const* kSystemCategory = "__system";

/// Bytes from one robot's user data to the next one's.
std::size_t stride_of(std::size_t user_data_bytes) {
    std::size_t const bytes = std::max<std::size_t>(user_data_bytes, 1);
    return (bytes + kUserDataAlignment - 1) / kUserDataAlignment * kUserDataAlignment;
}

void load_globals(LoopGlobals const& loop) {
    main_loop_hz = loop.loop_hz;
    max_nb_processed_msg_per_tick = loop.max_messages_per_tick;
    percent_msgs_sent_per_ticks = loop.send_percent;
    error_codes_led_idx = loop.error_led;
    msg_rx_fn = loop.receive;
    msg_tx_fn = loop.send;
    nb_msgs_sent = loop.sent;
    nb_msgs_recv = loop.received;
    _current_time_milliseconds = loop.milliseconds;
    _error_code_initial_time = loop.error_shown_at_ms;
    _global_timer = loop.global_timer;
    timer_main_loop = loop.loop_timer;
}

LoopGlobals stored_globals() {
    return {.loop_hz = main_loop_hz,
            .max_messages_per_tick = max_nb_processed_msg_per_tick,
            .send_percent = percent_msgs_sent_per_ticks,
            .error_led = error_codes_led_idx,
            .receive = msg_rx_fn,
            .send = msg_tx_fn,
            .sent = nb_msgs_sent,
            .received = nb_msgs_recv,
            .milliseconds = _current_time_milliseconds,
            .error_shown_at_ms = _error_code_initial_time,
            .global_timer = _global_timer,
            .loop_timer = timer_main_loop};
}

/// Like the C library, calls main() with arguments, whether it takes them or not. C leaves that undefined, and
/// clang's sanitizer says so.
#ifdef __clang__
[[clang::no_sanitize("function")]]
#endif
void call_main(int (*function)(), char** arguments) {
    using Main = int (*)(int, char**, char**);
    reinterpret_cast<Main>(reinterpret_cast<void (*)()>(function))(1, arguments, environment());
}

}  // namespace

Controllers::Controllers(ProgramImage image, World& world, RunServices& services, std::uint64_t seed,
                         std::size_t stack_bytes)
    : image_(std::move(image)), world_(world), services_(services), fibers_(stack_bytes) {
    services_.controllers = this;
    std::size_t const count = world.robots.size();
    auto const purpose = [&] {
        return fmt::format("the controllers of {}, {} bytes each", counted(count, "robot"), sizeof(Controller));
    };
    allocate_for(purpose, static_cast<double>(count * sizeof(Controller)), [&] { controllers_.resize(count); });
    for (std::uint32_t category = 0; category < world.categories.size(); ++category) {
        auto const& robot = world.categories[category].spec.robot;
        RobotRange const range = robots_of(world, category);
        if (!robot || !needs_program(robot->brain) || range.size() == 0) {
            continue;
        }
        if (!ranges_.empty() && ranges_.back().last == range.first) {
            ranges_.back().last = range.last;
        } else {
            ranges_.push_back(range);
        }
    }
    allocate_user_data();
    draw_seeds(seed);
    count_time();
}

std::size_t Controllers::driven_count() const {
    std::size_t count = 0;
    for (RobotRange const range : ranges_) {
        count += range.size();
    }
    return count;
}

Controllers::~Controllers() {
    if (context.world == &world_) {
        context = {};
    }
}

std::size_t Controllers::user_data_stride() const {
    return stride_of(image_.user_data_bytes);
}

Controllers::Thread::Thread(Controllers& controllers) : controllers_(controllers) {
    set_callbacks_of_thread(controllers.callbacks_);
}

Controllers::Thread::~Thread() {
    controllers_.callbacks_ = callbacks_of_thread();
}

Controllers::Callbacks Controllers::callbacks_of_thread() {
    return {.global_setup = callback_global_setup,
            .create_data_schema = callback_create_data_schema,
            .global_step = callback_global_step};
}

void Controllers::set_callbacks_of_thread(Callbacks const& callbacks) {
    callback_global_setup = callbacks.global_setup;
    callback_create_data_schema = callbacks.create_data_schema;
    callback_global_step = callbacks.global_step;
}

void Controllers::allocate_user_data() {
    // One block for all, the last place for the global step.
    std::size_t const stride = user_data_stride();
    std::size_t const blocks = controllers_.size() + 1;
    auto const purpose = [&] {
        return fmt::format("the user data (USERDATA) of {} and the global step, {} bytes each",
                           counted(controllers_.size(), "robot"), image_.user_data_bytes);
    };
    allocate_for(purpose, static_cast<double>(stride) * static_cast<double>(blocks), [&] {
        if (stride > std::numeric_limits<std::ptrdiff_t>::max() / blocks) {
            throw std::bad_alloc();
        }
        user_data_ = GuardedMemory(stride * blocks);
    });
    for (std::size_t i = 0; i < controllers_.size(); ++i) {
        controllers_[i].user_data = user_data_.data() + i * stride;
    }
    system_.user_data = user_data_.data() + controllers_.size() * stride;
    services_.program_variables = image_.variables;
    services_.user_data = {user_data_.data(), stride * blocks};
}

void Controllers::give_robots_own_memory() {
    if (std::string const reason = why_memory_is_shared(image_); !reason.empty()) {
        throw ConfigError(fmt::format("robot_memory: own needs to know the program's variables, but {}", reason));
    }
    own_variables_ = image_.memory_of_robots();
    own_memory_ = std::make_unique<RobotMemory>(own_variables_, static_cast<std::uint32_t>(controllers_.size()));
}

void Controllers::set_for_all(BoundVariable const& bound, ParameterSource& source) {
    bound.read(source, bound.name, bound.variable, bound.size);
    if (own_memory_) {
        own_memory_->give_to_all({static_cast<std::byte const*>(bound.variable), bound.bytes});
    }
}

void Controllers::draw_seeds(std::uint64_t seed) {
    for (std::uint32_t i = 0; i < controllers_.size(); ++i) {
        controllers_[i].random = random_of_program(seed, i);
        controllers_[i].seeds = random_seeds(seed, i, id_on_air(world_.robots.id[i]));
    }
    system_.random = random_of_program(seed, kNone);
    system_.seeds = random_seeds(seed, kNone, 0);
}

/// The code of some categories takes time of the robots' clocks.
void Controllers::count_time() {
    for (std::uint32_t category = 0; category < world_.categories.size(); ++category) {
        auto const& [name, spec] = world_.categories[category];
        RobotRange const range = robots_of(world_, category);
        bool const is_program = spec.robot && needs_program(spec.robot->brain) && range.size() > 0;
        if (!is_program || spec.robot->cpu_time != CpuTime::counted || spec.robot->function_costs.empty()) {
            continue;
        }
        function_times_.push_back(std::make_unique<FunctionTimes>(name, *spec.robot, image_));
        for (std::uint32_t robot = range.first; robot < range.last; ++robot) {
            controllers_[robot].times = function_times_.back().get();
        }
    }
}

Controller& Controllers::controller(std::uint32_t robot) {
    return robot == kNone ? system_ : controllers_[robot];
}

void Controllers::enter(std::uint32_t robot, Phase phase) {
    Controller& self = controller(robot);
    context = {.world = &world_,
               .services = &services_,
               .controller = &self,
               .robot = robot,
               .device = world_.device_of(robot),
               .phase = phase,
               .step_us = step_us_,
               .printed = &self.printed,
               .outbox = context.outbox,
               .is_system = robot == kNone,
               .has_own_memory = own_memory_ != nullptr};
    if (own_memory_) {
        without_exceptions([&] { own_memory_->load(robot); });
    }
    pogosim_mydata = self.user_data;
    if (image_.plain_mydata != nullptr) [[unlikely]] {
        *image_.plain_mydata = image_.user_data_bytes > 0 ? self.user_data : nullptr;
    }
    self.calls = 0;
    load_globals(self.loop);
    pogobot_ticks = context.devices().ticks[context.device];
    restart_watch();
}

void Controllers::note_callbacks(Program& program) {
    program.export_data = callback_export_data;
    program.end = callback_robot_end;
    program.click = callback_robot_click;
}

void Controllers::set_callbacks(Program const& program) {
    callback_export_data = program.export_data;
    callback_robot_end = program.end;
    callback_robot_click = program.click;
}

/// Calls code of the whole run, such as callback_global_setup, with a robot's memory in place.
void Controllers::enter_as_system(std::uint32_t robot, Phase phase) {
    enter(robot, phase);
    context.printed = &system_.printed;
    context.is_system = context.sees_world = true;
}

void Controllers::leave() {
    context.controller->loop = stored_globals();
    context.devices().ticks[context.device] = pogobot_ticks;
    take_back_floating_point();
}

/// For the call, a robot that is switched off is as it was before that; it sends nothing.
void Controllers::call(std::uint32_t robot, Phase phase, void (*function)(), bool sees_world) {
    if (function == nullptr) {
        return;
    }
    SwitchedOff const* const off = find_switched_off(world_, robot);
    std::size_t const transmissions = world_.air.transmissions.size();
    std::size_t const payload_bytes = world_.air.payloads.size();
    int const calls = controller(robot).calls;
    if (off != nullptr) {
        wake(world_, *off);
    }
    enter(robot, phase);
    context.sees_world = sees_world;
    function();
    leave();
    controller(robot).calls = calls;  // a callback must not use up the calls of a robot that waits
    if (SwitchedOff* const still_off = find_switched_off(world_, robot)) {
        rest(world_, *still_off);
        world_.air.transmissions.resize(transmissions);
        world_.air.payloads.resize(payload_bytes);
    }
}

void Controllers::call_as_system(std::uint32_t robot, Phase phase, void (*function)()) {
    if (function != nullptr) {
        enter_as_system(robot, phase);
        function();
        leave();
    }
}

/// In C++, constructs the globals of all robots before the first main(). Objects that they share (POGO_SHARED) are
/// constructed by each robot.
void Controllers::construct_static_objects() {
    if (own_memory_ && image_.constructors) {
        for_each_robot([this](std::uint32_t robot) {
            enter(robot, Phase::construct_static_objects);
            construct_again(*image_.constructors, own_variables_);
            leave();
        });
    }
}

void Controllers::construct_user_data(std::uint32_t robot) {
    if (image_.construct_user_data != nullptr) {
        enter(robot, Phase::construct_user_data);
        image_.construct_user_data(pogosim_mydata);
        leave();
    }
}

void Controllers::run_main(std::uint32_t robot) {
    enter(robot, Phase::main);
    context.waiting = image_.is_for_sdk ? Waiting::always : Waiting::never;
    callback_export_data = callback_robot_end = callback_robot_click = nullptr;
    // A program may modify its arguments, so each robot gets a fresh copy; those of programs for the SDK keep theirs.
    MainArguments& arguments = main_arguments_[image_.is_for_sdk && robot != kNone ? robot : 0];
    arguments.name = image_.name;
    arguments.values = {arguments.name.data(), nullptr};
    call_main(image_.main, arguments.values.data());
    leave();
    note_callbacks(controller(robot).program);
}

void Controllers::run_init(std::uint32_t robot) {
    if (void (*const init)() = controllers_[robot].program.init) {
        enter(robot, Phase::user_init);
        context.waiting = Waiting::for_inputs;
        init();
        leave();
    }
}

/// mydata is that of the last robot here, because existing programs read it in callback_global_setup.
void Controllers::run_global_setup() {
    std::uint32_t const robot = ranges_.empty() ? kNone : ranges_.back().last - 1;
    auto const digest = [this, robot] {
        return std::hash<std::string_view>()(
            {reinterpret_cast<char const*>(controller(robot).user_data), user_data_bytes()});
    };
    std::size_t const before = digest();
    if (own_memory_) {
        own_memory_->load(robot);
        own_memory_->begin_common_change();
    }
    call_as_system(robot, Phase::global_setup, callback_global_setup);
    if (own_memory_) {
        for (BoundVariable const& bound : services_.bound_variables) {
            own_memory_->give_to_all({static_cast<std::byte const*>(bound.variable), bound.bytes});
        }
        own_memory_->end_common_change();
    }
    without_exceptions([this] { services_.edit.settle_light(); });
    if (robot != kNone && controllers_.size() > 1 && digest() != before && !services_.gave_user_data) {
        warn_of_user_data_in_setup(world_.robots.id[robot]);
    }
}

void Controllers::start() {
    auto const count = static_cast<std::uint32_t>(controllers_.size());
    main_arguments_.resize(image_.is_for_sdk ? std::max(1U, count) : 1U);
    std::size_t const memory_bytes = least_memory_bytes(world_);
    warn_of_large_memory("USERDATA has", user_data_bytes(), memory_bytes);
    warn_of_large_memory("the program's variables have", own_memory_ ? own_memory_->bytes() : 0, memory_bytes);
    // Pages of flash memory are on the computer's heap, but not in the robot's memory.
    auto const allocated_by_robots = [this] {
        std::size_t bytes = allocated_bytes();
        for (Flash const& flash : world_.devices.flash) {
            bytes -= std::min(bytes, allocated_bytes(flash));
        }
        return bytes;
    };
    // In a host's process, other threads allocate, too; and to count takes a tenth of a reset.
    bool const is_alone = run_stage() != RunStage::hosted;
    std::size_t const before = is_alone ? allocated_by_robots() : 0;
    start_programs();
    std::size_t const now = is_alone ? allocated_by_robots() : 0;
    warn_of_large_heap(now - std::min(before, now), driven_count(), memory_bytes);
}

void Controllers::start_programs() {
    construct_static_objects();
    if (image_.is_for_sdk) {
        start_sdk_program();
        return;
    }
    construct_user_data(kNone);
    for_each_robot([this](std::uint32_t robot) { construct_user_data(robot); });
    if (ranges_.empty() && image_.main != nullptr) {
        // No robot runs main(): only what the global callbacks need.
        run_main(kNone);
    }
    for_each_robot([this](std::uint32_t robot) { run_main(robot); });
    warn_of_idle_categories(world_, controllers_, services_.started_categories);
    run_global_setup();
    for_each_robot([this](std::uint32_t robot) {
        if (is_alive(world_, robot)) {
            run_on_fiber(robot, &Controllers::run_init);
        } else {
            call(robot, Phase::user_init, controllers_[robot].program.init);
        }
    });
    warn_of_missing_init(controllers_);
    warn_of_equal_seeds(controllers_);
}

/// Runs main() until it waits for the first time. Walls and membranes have no such program.
void Controllers::start_sdk_program() {
    for_each_robot([this](std::uint32_t robot) {
        bool const is_robot =
            world_.robots.body[robot] != kNone && !world_.categories[world_.robots.category[robot]].spec.membrane;
        world_.devices.clock_us[robot] = is_robot ? 0 : kIdle;
        if (is_robot) {
            run_on_fiber(robot, &Controllers::run_sdk_main);
            controllers_[robot].program.registered = true;
        }
    });
    begun_with_ = callbacks_of_thread();
    run_global_setup();
    warn_of_missing_init(controllers_);
    warn_of_equal_seeds(controllers_);
}

void Controllers::run_sdk_main(std::uint32_t robot) {
    run_main(robot);
    controllers_[robot].program.returned = true;
    world_.devices.clock_us[robot] = kIdle;
    drive(world_, robot);
}

/// Warns of callbacks that are set too late, since they run once, before the first step.
void Controllers::warn_of_late_callbacks() {
    auto const warn_if = [this](bool is_late, char const* name) {
        if (is_late) {
            services_.warn_once("{} is set after main() has waited for the first time: it is not called; set it before",
                                name);
        }
    };
    if (begun_with_) {
        warn_if(callback_global_setup != nullptr && begun_with_->global_setup == nullptr, "callback_global_setup");
        warn_if(callback_create_data_schema != nullptr && begun_with_->create_data_schema == nullptr,
                "callback_create_data_schema");
    }
}

void Controllers::declare_columns() {
    services_.data.declaring = services_.data.is_declared = true;
    call_as_system(kNone, Phase::create_data_schema, callback_create_data_schema);
    services_.data.declaring = false;
    if (driven_count() == 0) {
        return;  // other brains drive all robots
    }
    if (callback_global_step == nullptr && services_.data.held.empty()) {
        warn_of_empty_columns(services_.data.columns, controllers_);
    } else {
        auto const exports = [](Controller const& self) { return self.program.export_data != nullptr; };
        services_.data.awaits_step = std::ranges::none_of(controllers_, exports);
    }
}

void Controllers::run_step() {
    begin_step();
    run_robots(0, static_cast<std::uint32_t>(controllers_.size()));
    end_step();
}

void Controllers::end_step() const {
    assert_controllers(world_, controllers_);
}

void Controllers::begin_step() {
    step_us_ = time_us(world_);
    if (is_restart_due_.exchange(false)) [[unlikely]] {
        restart_robots();
    }
    warn_of_unreturned_calls_if_due();
    if (callback_global_step != nullptr && step_us_ >= world_.devices.clock_us[world_.device_of(kNone)]) {
        enter(kNone, Phase::global_step);
        context.sees_world = true;
        pogo_main_loop_step(callback_global_step);
        leave();
        without_exceptions([this] { services_.edit.settle_light(); });
    }
}

void Controllers::take_over(Outbox& outbox) {
    world_.air.append(outbox.air);
    for (Outbox::Said const& said : outbox.said) {
        if (said.kind.text.empty()) {
            services_.print_line(world_, said.robot, said.text);
        } else {
            services_.warn_first(said.kind, said.text);
        }
    }
    services_.stop_requested = services_.stop_requested || outbox.stop_requested;
}

std::string Controllers::why_one_after_the_other() const {
    if (own_memory_) {
        return "each has its own memory (robot_memory: own), which is put into the program before its step";
    }
    if (gave_user_data()) {
        return "callback_global_setup has had USERDATA of robots, and may have put the same address into several";
    }
    return pogosim::why_one_after_the_other(image_, services_.bound_variables);
}

void Controllers::warn_of_shared_variables() const {
    auto const runs_program = [](Controller const& self) {
        return self.program.registered && self.program.step != default_walls_user_step;
    };
    auto const robots = static_cast<std::size_t>(std::ranges::count_if(controllers_, runs_program));
    if (!own_memory_) {
        pogosim::warn_of_shared_variables(image_, services_.bound_variables, robots);
    }
}

ConfiguredVariables Controllers::configured_variables() const {
    return {image_, services_.bound_variables};
}

void Controllers::tick(std::uint32_t robot) {
    Controller& self = controllers_[robot];
    self.polled_us = 0.0;
    measure_at_tick(world_, robot);
    enter(robot, Phase::user_step);
    if (are_odd(self.loop, most_loop_hz_)) [[unlikely]] {
        without_exceptions([&] { note_loop_globals(world_, self.loop, most_loop_hz_); });
    }
    context.waiting = Waiting::always;
    pogo_main_loop_step(self.program.step);
    leave();
    drift_clock(world_, robot, self.loop.loop_timer.origin_us);
    drive(world_, robot);
}

bool Controllers::export_row(std::size_t robot, std::uint32_t object, std::span<CellValue> cells) {
    DataExport& data = services_.data;
    data.held.fill(object, cells);
    data.row = {.values = cells, .exported = true};
    data.filling = true;
    data.next_column = 0;
    std::int64_t const clock_us = world_.devices.clock_us[robot];
    call(static_cast<std::uint32_t>(robot), Phase::export_data, controllers_[robot].program.export_data);
    world_.devices.clock_us[robot] = clock_us;  // how often rows are saved changes nothing
    data.filling = false;
    data.filled_rows += data.row.exported && controllers_[robot].program.export_data != nullptr ? 1 : 0;
    return data.row.exported;
}

bool Controllers::click(std::uint32_t robot) {
    void (*const callback)() = controllers_[robot].program.click;
    call(robot, Phase::robot_click, callback, /*sees_world=*/true);
    without_exceptions([this] { services_.edit.settle_light(); });
    return callback != nullptr;
}

void Controllers::end() {
    for (std::uint32_t i = 0; i < controllers_.size(); ++i) {
        call(i, Phase::robot_end, controllers_[i].program.end);
    }
}

void Controllers::print_unfinished_lines() {
    auto const print_rest = [this](std::uint32_t robot) {
        if (!controller(robot).printed.empty()) {
            call(robot, Phase::last_line, [] { pogosim_puts(""); });
        }
    };
    for (std::uint32_t i = 0; i < controllers_.size(); ++i) {
        print_rest(i);
    }
    print_rest(kNone);
}

void Controllers::warn_of_stacks() const {
    warn_of_large_stack(own_memory_ ? own_memory_->bytes() : user_data_bytes(), fibers_.deepest_bytes(),
                        least_memory_bytes(world_));
}

void Controllers::tell_at_end(std::uint64_t arrivals) const {
    warn_of_lost_messages(world_, controllers_);
    warn_of_commands(world_);
    warn_of_unused_messages(world_, controllers_, arrivals);
    warn_of_undecoded_messages(controllers_);
    warn_of_send_results(controllers_);
    tell_of_lost_flash_writes(world_);
    tell_of_ended_programs(controllers_);
    for (std::unique_ptr<FunctionTimes> const& times : function_times_) {
        times->tell_at_end();
    }
}

void Controllers::tell_of_unset_columns(std::optional<std::vector<std::string>> const& fields) const {
    pogosim::tell_of_unset_columns(services_.data, fields);
}

void Controllers::watch_loop_rates() {
    most_loop_hz_ = std::numeric_limits<std::uint8_t>::max();
    while (skips_ticks(most_loop_hz_, world_.time_step_s)) {
        --most_loop_hz_;
    }
}

int Controllers::highest_loop_hz() const {
    int highest = 0;
    for (Controller const& self : controllers_) {
        highest = std::max<int>(highest, self.loop.loop_hz);
    }
    return highest;
}

}  // namespace pogosim

using pogosim::context;
using pogosim::require_argument;
using pogosim::require_robot;

char const* get_current_robot_category() {
    require_robot(__func__);
    if (!context.has_robot()) {
        return pogosim::kSystemCategory;
    }
    return context.world->categories[context.world->robots.category[context.robot]].name.c_str();
}

bool current_robot_category_is(char const* category) {
    require_robot(__func__);
    return category != nullptr && std::string_view(category) == get_current_robot_category();
}

void _pogobot_start(void (*user_init)(), void (*user_step)(), char const* category) {
    require_robot("pogobot_start");
    require_argument(category, "pogobot_start", "the category");
    std::vector<std::string>& started = context.services->started_categories;
    if (std::ranges::find(started, category) == started.end()) {
        started.emplace_back(category);
    }
    if (!current_robot_category_is(category)) {
        return;
    }
    if (context.controller->program.registered) {
        context.services->warn_once(
            "pogobot_start() is called again for the category '{}': the simulator uses the last call, a real robot the "
            "first",
            category);
    }
    context.controller->program.registered = true;
    context.controller->program.init = user_init;
    context.controller->program.step = user_step;
    pogobot_ticks = 0;
    pogobot_stopwatch_reset(&_global_timer);
    pogobot_stopwatch_reset(&timer_main_loop);
}
