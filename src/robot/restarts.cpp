// Robots that restart, as real ones do when the remote control resets them: the program begins anew with its memory as
// it starts with. What the hardware keeps, stays: its place, its calibration, its flash, the stored settings of motors.
#include <cstdlib>
#include <cstring>
#include <utility>

#include "device/motors.hpp"
#include "device/set_up.hpp"
#include "process/crash_handler.hpp"
#include "robot/controllers.hpp"

namespace pogosim {

namespace {

/// Clears what a reset of the processor clears of the program.
void forget(Controller& self) {
    self.program = {};
    self.loop = {};
    self.calls = self.waits = 0;
}

}  // namespace

void Controllers::ask_for_restart() {
    Controller& self = controllers_[context.robot];
    self.is_restart_due = is_restart_due_ = true;
    if (context.waiting != Waiting::always) {
        return;
    }
    context.clock_us() = step_us_ + 1;
    self.fiber = running_fiber();
    leave();
    leave_fiber();
    std::abort();  // nothing resumes it
}

void Controllers::restart_robots() {
    for (std::uint32_t i = 0; i < controllers_.size(); ++i) {
        if (controllers_[i].is_restart_due && is_alive(world_, i)) {
            restart(i);
        }
        is_restart_due_ = is_restart_due_ || controllers_[i].is_restart_due;  // of robots that are switched off: later
    }
}

/// What callback_global_setup wrote into the variables of each robot stands there again, after main() as at the start.
void Controllers::repeat_global_setup(std::uint32_t robot) {
    if (own_memory_) {
        without_exceptions([&] {
            own_memory_->load(robot);
            own_memory_->repeat_common_changes();
        });
    }
}

/// As start_programs() does for all. Robots share variables unless they have their own memory: those stay as they are.
void Controllers::restart(std::uint32_t robot) {
    Controller& self = controllers_[robot];
    if (Fiber* const fiber = std::exchange(self.fiber, nullptr)) {
        fibers_.discard(*fiber);
    }
    forget(self);
    self.is_restart_due = false;
    reset_devices(world_, robot, step_us_);
    self.random = random_of_program(services_.seed, robot);
    std::memset(self.user_data, 0, user_data_bytes());
    if (own_memory_) {
        without_exceptions([&] {
            own_memory_->begin_anew(robot);
            for (BoundVariable const& bound : services_.bound_variables) {
                bound.read(*services_.parameters, bound.name, bound.variable, bound.size);
            }
        });
        if (image_.constructors) {
            enter(robot, Phase::construct_static_objects);
            construct_again(*image_.constructors, own_variables_);
            leave();
        }
    }
    if (image_.is_for_sdk) {
        run_on_fiber(robot, &Controllers::run_sdk_main);
        repeat_global_setup(robot);
        self.program.registered = true;
    } else {
        construct_user_data(robot);
        run_main(robot);
        repeat_global_setup(robot);
        run_on_fiber(robot, &Controllers::run_init);
    }
    drive(world_, robot);
}

}  // namespace pogosim
