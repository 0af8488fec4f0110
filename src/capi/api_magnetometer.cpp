// pogolib/magnetometer.h, and magn_check() of the SDK's magnetometer.h
#include <cstdint>

#include "device/magnetometer.hpp"
#include "process/crash_handler.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"
#include "robot/robot_floating_point.hpp"
#include "robot/waiting.hpp"

extern "C" __attribute__((visibility("default"))) std::uint8_t magn_check();

using pogosim::context;
using pogosim::require_robot;

namespace {

/// False in callbacks of the whole run and walls, too.
bool finds_magnetometer() {
    return context.has_robot() && pogosim::has_magnetometer(*context.world, context.robot);
}

bool are_given(int16_t const* x, int16_t const* y, int16_t const* z) {
    if (x == nullptr || y == nullptr || z == nullptr) [[unlikely]] {
        pogosim::note_slip({"magn_read_XYZ",
                            x == nullptr   ? "x"
                            : y == nullptr ? "y"
                                           : "z",
                            "an address", "nothing is read, and 1 is returned"},
                           "NULL");
        return false;
    }
    return true;
}

/// One such call may be there to discard old data, before another one that waits.
void look_for_calls_without_time(std::uint16_t timeout_ms) {
    pogosim::Magnetometer& self = context.devices().magnetometer[context.device];
    if (timeout_ms == 0 && self.did_not_wait) [[unlikely]] {
        context.services->warn_once(
            "magn_read_XYZ() is called again and again with timeout_ms 0: a real robot then does not look for data, "
            "and returns 1 each time, as with magnetometer.timing: robot; new data come every 20 ms, so wait longer");
    }
    self.did_not_wait = timeout_ms == 0;
}

/// Afterwards the robot may be in another thread, see waiting.cpp.
[[gnu::noinline]] bool wait_for_data(std::uint16_t timeout_ms) {
    if (context.world->magnetometer.timing == pogosim::MagnetometerTiming::at_once) {
        look_for_calls_without_time(timeout_ms);
        return true;
    }
    std::int64_t const now_us = context.clock_us();
    pogosim::MagnetometerPoll const poll =
        pogosim::poll_magnetometer(now_us, context.devices().magnetometer[context.device].taken, timeout_ms);
    if (poll.wait_us > 0) {
        pogosim::sleep_until(now_us + poll.wait_us);
    }
    return poll.finds_data;
}

[[gnu::noinline]] pogosim::MagneticCounts take_data() {
    auto const counts = pogosim::read_magnetometer(*context.world, context.robot);
    if (!counts) {
        auto const text = pogosim::refused_pose_text(pogosim::magnetometer_pose(*context.world, context.robot));
        pogosim::refuse_user_code(text.data());
    }
    return *counts;
}

}  // namespace

uint8_t magn_init() {
    require_robot(__func__);
    return finds_magnetometer() ? 1 : 0;
}

uint8_t magn_check() {
    require_robot(__func__);
    return finds_magnetometer() ? 0 : 1;
}

int magn_read_XYZ(int16_t* x, int16_t* y, int16_t* z, uint16_t timeout_ms) {
    require_robot(__func__);
    pogosim::note_call();
    pogosim::take_back_floating_point();
    if (!are_given(x, y, z) || !finds_magnetometer() || !wait_for_data(timeout_ms)) {
        return 1;
    }
    pogosim::MagneticCounts const counts = take_data();
    *x = counts[0];
    *y = counts[1];
    *z = counts[2];
    return 0;
}

void magn_begin() {
    require_robot(__func__);
}

void magn_end() {
    require_robot(__func__);
}
