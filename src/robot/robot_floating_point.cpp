#include "robot/robot_floating_point.hpp"

#include "robot/context.hpp"

namespace pogosim {

void take_back_changed_floating_point() {
    set_floating_point_mode(kStandardMode);
    context.services->warn_once(
        "the program changed the mode of the floating-point unit (rounding, denormal numbers or traps); the simulator "
        "sets it back when the function returns, waits, reads a sensor or sends. A real robot has no such unit: it "
        "rounds to nearest");
}

}  // namespace pogosim
