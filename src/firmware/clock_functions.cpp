// Stopwatches, timers and sleeps of a firmware. A time_reference_t of a robot has 32 bits: spans beyond 35 minutes wrap
// around.
#include <algorithm>
#include <array>
#include <cstdint>

#include "device/arguments.hpp"
#include "firmware/firmware_call.hpp"

namespace pogosim {

namespace {

constexpr std::int64_t kUsPerMs = 1000;
constexpr std::int64_t kUsPerS = 1000000;

std::uint32_t now(FirmwareCall const& call) {
    return static_cast<std::uint32_t>(call.clock_us());
}

/// The clock shows at least this time. A sleep that is over already is a call like any other.
CallOutcome sleep_until(FirmwareCall& call, std::int64_t clock_us) {
    std::int64_t& own_us = call.clock_us();
    if (clock_us <= own_us) {
        return CallOutcome::returns;
    }
    own_us = std::min(clock_us, std::max(own_us, kIdle - 1));
    call.self.calls = 0;
    return CallOutcome::sleeps;
}

/// Sleeps for microseconds, milliseconds or seconds.
template <std::int64_t UnitUs>
CallOutcome sleep(FirmwareCall& call) {
    constexpr char const* unit = UnitUs == 1 ? "microseconds" : UnitUs == kUsPerMs ? "milliseconds" : "seconds";
    check_duration(unit, call.number(0), call);
    return sleep_until(call, call.clock_us() + std::max(0, call.number(0)) * UnitUs);
}

CallOutcome reset_stopwatch(FirmwareCall& call) {
    call.write_word(call.argument(0), now(call));
    return CallOutcome::returns;
}

CallOutcome elapsed(FirmwareCall& call) {
    call.give(now(call) - call.read_word(call.argument(0)));
    return CallOutcome::returns;
}

CallOutcome lap(FirmwareCall& call) {
    std::uint32_t const origin = call.argument(0);
    std::uint32_t const elapsed_us = now(call) - call.read_word(origin);
    call.write_word(origin, now(call));
    call.give(elapsed_us);
    return CallOutcome::returns;
}

CallOutcome offset_origin(FirmwareCall& call) {
    call.write_word(call.argument(0), call.read_word(call.argument(0)) + call.argument(1));
    return CallOutcome::returns;
}

CallOutcome init_timer(FirmwareCall& call) {
    call.write_word(call.argument(0), now(call) + call.argument(1));
    return CallOutcome::returns;
}

std::int32_t left_us(FirmwareCall const& call) {
    return static_cast<std::int32_t>(call.read_word(call.argument(0)) - now(call));
}

CallOutcome remaining(FirmwareCall& call) {
    call.give_signed(left_us(call));
    return CallOutcome::returns;
}

CallOutcome has_expired(FirmwareCall& call) {
    call.give(left_us(call) < 0 ? 1 : 0);
    return CallOutcome::returns;
}

CallOutcome wait_for_expiry(FirmwareCall& call) {
    return sleep_until(call, call.clock_us() + left_us(call));
}

}  // namespace

std::span<LibraryFunction const> clock_functions() {
    static std::array const functions{
        LibraryFunction{"msleep", sleep<kUsPerMs>},
        LibraryFunction{"usleep", sleep<1>},
        LibraryFunction{"sleep", sleep<kUsPerS>},
        LibraryFunction{"busy_wait", sleep<kUsPerMs>},  // of LiteX
        LibraryFunction{"busy_wait_us", sleep<1>},
        LibraryFunction{.name = "pogobot_stopwatch_reset",
                        .call = reset_stopwatch,
                        .noted = Noted::as_clock,
                        .use = StopwatchUse::resets},
        LibraryFunction{.name = "pogobot_stopwatch_get_elapsed_microseconds",
                        .call = elapsed,
                        .noted = Noted::as_clock,
                        .use = StopwatchUse::reads},
        LibraryFunction{.name = "pogobot_stopwatch_lap", .call = lap, .noted = Noted::as_clock},
        LibraryFunction{"pogobot_stopwatch_offset_origin_microseconds", offset_origin},
        LibraryFunction{.name = "pogobot_timer_init", .call = init_timer, .noted = Noted::as_clock},
        LibraryFunction{
            .name = "pogobot_timer_get_remaining_microseconds", .call = remaining, .noted = Noted::as_clock},
        LibraryFunction{.name = "pogobot_timer_has_expired", .call = has_expired, .noted = Noted::as_clock},
        LibraryFunction{"pogobot_timer_wait_for_expiry", wait_for_expiry},
        LibraryFunction{"pogobot_timer_offset_origin_microseconds", offset_origin},
        LibraryFunction{"pli_timer_sleep_stopwatch_init", do_nothing},
    };
    return functions;
}

}  // namespace pogosim
