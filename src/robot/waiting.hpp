// Programs that wait in the middle of a step: msleep(), or a loop until a message comes or some time has passed. They
// return control to the simulator, and go on in the step of the simulation in which their robot's clock is reached.
//
// The code of a robot takes no simulated time, so a loop that waits would wait for ever. Beyond kFreeCalls, each call
// takes the time that it takes on a robot.
#pragma once

#include <cstdint>

#include "device/clock.hpp"
#include "robot/context.hpp"

namespace pogosim {

/// The robot sleeps until its clock shows this time; one that has passed counts as any other call.
void sleep_until(std::int64_t clock_us);

/// The clock has gone on: the robot goes on when it is reached, perhaps in another thread.
void wait_for_clock();

void take_time_to_read_clock();
void take_time_to_read_input();

/// The robot reads its clock.
inline void note_clock_read() {
    if (++context.controller->calls > kFreeCalls) [[unlikely]] {
        take_time_to_read_clock();
    }
}

/// The robot does what may be in a loop that waits: it reads a sensor, looks for messages, or sends something.
inline void note_call() {
    if (++context.controller->calls > kFreeCalls) [[unlikely]] {
        take_time_to_read_input();
    }
}

}  // namespace pogosim
