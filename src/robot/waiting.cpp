#include "robot/waiting.hpp"

#include <algorithm>

#include "robot/controllers.hpp"

namespace pogosim {

namespace {

/// After it, nothing that belongs to this thread may be used: the robot may go on in another one.
void wait_for_step(Waiting least) {
    if (context.waiting >= least && context.clock_us() > context.step_us) {
        context.services->controllers->wait();
    }
}

}  // namespace

void sleep_until(std::int64_t clock_us) {
    std::int64_t& own_us = context.clock_us();
    if (clock_us <= own_us) {
        note_call();
        return;
    }
    // Long sleeps in a loop in a callback, which does not wait, end there; a robot that is switched off stays so.
    own_us = std::min(clock_us, std::max(own_us, kIdle - 1));
    context.controller->calls = 0;
    wait_for_step(Waiting::always);
}

void wait_for_clock() {
    wait_for_step(Waiting::always);
}

void take_time_to_read_clock() {
    context.clock_us() += kCallUs;
    context.controller->polled_us += kCallUs;
    wait_for_step(Waiting::always);
}

void take_time_to_read_input() {
    if (context.waiting != Waiting::never) {
        context.clock_us() += kCallUs;
        context.controller->polled_us += kCallUs;
        wait_for_step(Waiting::for_inputs);
    }
}

}  // namespace pogosim
