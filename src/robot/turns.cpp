// How the robots of a step take turns, and wait in the middle:
//
//   run_robots() ──► take_turns(), on a fiber ──► tick() of robot 0, 1, 2, ...
//        ▲                                            │ msleep() of robot 2, or a loop of its: wait()
//        │                                            ▼
//        └──────────────── leave_fiber() ─── the fiber is robot 2's; its clock is ahead
//   run_robots() ──► take_turns(), on another fiber ──► tick() of robot 3, ...
//
// In the step in which its clock is reached, run_robots() resumes the fiber of robot 2 (go_on()). wait() returns in
// there, and so do the rest of its tick and of take_turns(), which sees that the turns have gone on without it.
#include <pthread.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "device/clock.hpp"
#include "device/motors.hpp"
#include "device/sensing.hpp"
#include "process/crash_handler.hpp"
#include "process/process.hpp"
#include "robot/controllers.hpp"

namespace pogosim {

namespace {

/// Whether code that waits may go on in another thread. It is compiled as if that never happened, so it may keep the
/// address of a variable that each thread has, such as mydata, in a register. On x86-64, such variables are read and
/// written without their address.
constexpr bool can_change_threads() {
#ifdef __x86_64__
    return true;
#else
    return false;
#endif
}

}  // namespace

void Controllers::run_on_fiber(std::uint32_t robot, void (Controllers::*part)(std::uint32_t)) {
    struct Call {
        Controllers& controllers;
        std::uint32_t robot;
        void (Controllers::*part)(std::uint32_t);
    };
    Call call{*this, robot, part};
    Fiber& fiber = free_fiber();
    auto const body = [](void* argument) {
        Call const copy = *static_cast<Call*>(argument);  // the robot may still run when `call` is gone
        (copy.controllers.*copy.part)(copy.robot);
    };
    if (run_on(fiber, body, &call)) {
        fibers_.put_back(fiber);
    }
}

Fiber& Controllers::free_fiber() {
    Fiber* fiber = nullptr;
    without_exceptions([&] { fiber = &fibers_.take(); });
    return *fiber;
}

void Controllers::wait() {
    if (is_forked_child()) {
        end_forked_child(0);  // the rest of the run belongs to the parent
    }
    std::uint32_t const robot = context.robot;
    Controller& self = controllers_[robot];
    // A program may also call the main loop's step itself: then it ticks, and has begun another call.
    if (self.fiber == nullptr || pogobot_ticks != self.call_ticks) {
        self.waits = 0;
        self.call_began_us = step_us_;
        self.call_ticks = pogobot_ticks;
    }
    ++self.waits;
    self.waits_in = context.phase;
    self.waits_on = pthread_self();
    self.fiber = running_fiber();
    has_waited_ = true;
    leave();
    if (self.waits_in == Phase::main) {
        note_callbacks(self.program);
        warn_of_late_callbacks();
        drift_clock(world_, robot, self.went_on_us);
    }
    drive(world_, robot);
    leave_fiber();
}

void Controllers::go_on(std::uint32_t robot) {
    Controller& self = controllers_[robot];
    measure_at_tick(world_, robot);
    int const calls = self.calls;
    enter(robot, self.waits_in);
    if (!can_change_threads() && pthread_equal(self.waits_on, pthread_self()) == 0) {
        refuse_user_code(
            "a robot that waits in the middle of its program can only go on in the thread in which it began to (on "
            "this processor): run it with threads: 1, and let one thread of Python step it");
    }
    self.calls = calls;
    context.waiting = Waiting::always;
    self.went_on_us = world_.devices.clock_us[robot];
    if (self.waits_in == Phase::main) {
        set_callbacks(self.program);
    }
    if (resume(*self.fiber)) {
        fibers_.put_back(*std::exchange(self.fiber, nullptr));
        self.longest_call_us = std::max(self.longest_call_us, step_us_ - self.call_began_us);
    }
}

/// Robots that take their steps, one after the other, on a fiber: when one of them waits, it keeps the fiber until its
/// step is over, and the others continue on another one.
struct Controllers::Turns {
    Controllers& controllers;
    std::uint32_t next;
    std::uint32_t last;  // exclusive
};

void Controllers::run_robots(std::uint32_t first, std::uint32_t last) {
    for (RobotRange const range : ranges_) {
        run_range({.first = std::max(first, range.first), .last = std::min(last, range.last)});
    }
}

void Controllers::run_range(RobotRange range) {
    Turns turns{*this, range.first, range.last};
    while (turns.next < turns.last) {
        if (is_waiting(turns.next)) {
            go_on(turns.next);
            turns.next += is_due(turns.next) ? 0 : 1;
            continue;
        }
        Fiber& fiber = free_fiber();
        if (run_on(
                fiber,
                [](void* argument) {
                    static_cast<Turns*>(argument)->controllers.take_turns(*static_cast<Turns*>(argument));
                },
                &turns)) {
            fibers_.put_back(fiber);
        }
    }
}

bool Controllers::is_due(std::uint32_t robot) const {
    return step_us_ >= world_.devices.clock_us[robot];
}

bool Controllers::is_waiting(std::uint32_t robot) const {
    return is_due(robot) && controllers_[robot].fiber != nullptr;
}

void Controllers::take_turns(Turns& turns) {
    for (; turns.next < turns.last; ++turns.next) {
        std::uint32_t const robot = turns.next;
        Controller& self = controllers_[robot];
        if (!is_due(robot)) {
            continue;
        }
        if (self.fiber != nullptr) {
            return;  // run_robots() resumes its own fiber
        }
        if (self.loop.loop_hz == 0) {
            world_.devices.clock_us[robot] = step_us_;  // without a sleep the clock follows the steps
        }
        tick(robot);
        if (self.fiber != nullptr) {
            return;  // it has waited, and run_robots() has continued with another fiber since
        }
    }
}

}  // namespace pogosim
