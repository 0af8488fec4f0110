// main() of executables. The user's main(), renamed robot_main, is called by the simulator, once for each robot.
#include "pogosim/program.h"

// Before the constructors of the program, which may take for ever, or set handlers of their own.
__attribute__((constructor(101))) static void guard_process(void) {
    pogosim_guard_process();
}
POGO_OWN_INITIALIZER(guard_process)

int main(int argc, char** argv) {
    return pogosim_run_program(&pogosim_this_program, argc, argv);
}
