// pogolib/timers.h
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <thread>

#include "pogosim/program.h"
#include "process/process.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"
#include "robot/function_times.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::note_slip;
using pogosim::require_argument;
using pogosim::require_robot;

namespace {

constexpr std::int64_t kMicrosecondsPerMillisecond = 1000;
constexpr std::int64_t kMicrosecondsPerSecond = 1000000;

std::int64_t now_us() {
    pogosim::note_clock_read();
    return context.clock_us();
}

int32_t saturate(char const* function, std::int64_t us) {
    auto const fitting =
        std::clamp<std::int64_t>(us, std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max());
    if (fitting != us) [[unlikely]] {
        note_slip({function, "the time to return", "-2147483648 to 2147483647 us (35 minutes)",
                   "the nearest of these is returned; on a real robot, times wrap around after 107 s"},
                  us);
    }
    return static_cast<int32_t>(fitting);
}

/// Time since the origin, us; `function` is named in the warning if it does not fit.
int32_t elapsed_us(char const* function, time_reference_t const* stopwatch) {
    require_robot(function);
    require_argument(stopwatch, function, "stopwatch");
    return saturate(function, now_us() - stopwatch->origin_us);
}

/// Time left, us; `function` as above.
int32_t remaining_us(char const* function, time_reference_t const* timer) {
    require_robot(function);
    require_argument(timer, function, "timer");
    return saturate(function, timer->origin_us - now_us());
}

void set_origin(time_reference_t* reference, std::int64_t origin_us) {
    reference->origin_us = origin_us;
    reference->hardware_value_at_time_origin = static_cast<uint32_t>(origin_us);
}

/// Sleeps for `count` units of `unit_us` microseconds of the robot's time. Negative times take none.
void sleep_for(char const* function, char const* argument, int count, std::int64_t unit_us) {
    pogosim::check_duration(argument, count, pogosim::NoteSlip{function});
    pogosim::sleep_until(context.clock_us() + std::max(0, count) * unit_us);
}

/// The same for functions of the C library, which take wall-clock time in a thread or a process that the program has
/// started.
void sleep_as_in_c(char const* function, char const* argument, int count, std::int64_t unit_us) {
    if (context.controller == nullptr || pogosim::is_forked_child()) {
        std::this_thread::sleep_for(std::chrono::microseconds(std::max(0, count) * unit_us));
    } else {
        sleep_for(function, argument, count, unit_us);
    }
}

}  // namespace

void pogobot_stopwatch_reset(time_reference_t* stopwatch) {
    require_robot(__func__);
    require_argument(stopwatch, __func__, "stopwatch");
    set_origin(stopwatch, now_us());
}

int32_t pogobot_stopwatch_get_elapsed_microseconds(time_reference_t* stopwatch) {
    return elapsed_us(__func__, stopwatch);
}

int32_t pogobot_stopwatch_lap(time_reference_t* stopwatch) {
    int32_t const elapsed = elapsed_us(__func__, stopwatch);
    pogobot_stopwatch_reset(stopwatch);
    return elapsed;
}

void pogobot_stopwatch_offset_origin_microseconds(time_reference_t* stopwatch, int32_t microseconds_offset) {
    require_robot(__func__);
    require_argument(stopwatch, __func__, "stopwatch");
    set_origin(stopwatch, stopwatch->origin_us + microseconds_offset);
}

void pogobot_timer_init(time_reference_t* timer, int32_t microseconds_to_go) {
    require_robot(__func__);
    require_argument(timer, __func__, "timer");
    set_origin(timer, now_us() + microseconds_to_go);
}

int32_t pogobot_timer_get_remaining_microseconds(time_reference_t* timer) {
    return remaining_us(__func__, timer);
}

bool pogobot_timer_has_expired(time_reference_t* timer) {
    return remaining_us(__func__, timer) < 0;
}

void pogobot_timer_wait_for_expiry(time_reference_t* timer) {
    require_robot(__func__);
    require_argument(timer, __func__, "timer");
    pogosim::sleep_until(timer->origin_us);
}

void pogobot_timer_offset_origin_microseconds(time_reference_t* timer, int32_t microseconds_offset) {
    require_robot(__func__);
    require_argument(timer, __func__, "timer");
    pogobot_stopwatch_offset_origin_microseconds(timer, microseconds_offset);
}

void msleep(int milliseconds) {
    require_robot(__func__);
    sleep_for(__func__, "milliseconds", milliseconds, kMicrosecondsPerMillisecond);
}

void pogosim_usleep(int microseconds) {
    sleep_as_in_c("usleep", "microseconds", microseconds, 1);
}

void pogosim_sleep(int seconds) {
    sleep_as_in_c("sleep", "seconds", seconds, kMicrosecondsPerSecond);
}

void pogosim_let_time_pass() {
    require_robot("current_time_milliseconds");
    pogosim::note_clock_read();
}

void pogosim_take_time_of(void (*function)()) {
    pogosim::take_time_of(function);
}

void pogosim_take_time_of_tick(void (*user_step)()) {
    pogosim::take_time_of_tick(user_step);
}

/// The main loop's own way to read a stopwatch: pogobot_stopwatch_get_elapsed_microseconds().
extern "C" int32_t pogosim_elapsed_microseconds(time_reference_t* stopwatch);
int32_t pogosim_elapsed_microseconds(time_reference_t* stopwatch) {
    return saturate("current_time_milliseconds", context.clock_us() - stopwatch->origin_us);
}

void pogosim_sleep_after_tick(int milliseconds) {
    context.clock_us() += milliseconds * kMicrosecondsPerMillisecond;
}

void pli_timer_sleep_stopwatch_init() {}
