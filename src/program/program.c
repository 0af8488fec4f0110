// The part of the simulator that is linked into every program, executable or shared object.
#include "pogosim/program.h"

#include <stdlib.h>

#include "pogosim/version.h"

int robot_main(void);

// Functions and variables of the program alone: what others have by these names is another matter.
#define POGO_WITHIN_PROGRAM __attribute__((visibility("hidden")))
// Weak definitions of macOS would be one for all programs in a process.
#ifdef __APPLE__
#define POGO_UNLESS_DEFINED __attribute__((weak)) POGO_WITHIN_PROGRAM
#else
#define POGO_UNLESS_DEFINED __attribute__((weak))
#endif

// For programs without REGISTER_USERDATA.
POGO_UNLESS_DEFINED size_t UserdataSize = 0;
POGO_UNLESS_DEFINED void (*UserdataConstruct)(void*) = NULL;

// Defined in programs written for the robots' SDK, see pogobot.h.
#ifdef __APPLE__  // where the linker wants a definition
extern char const pogosim_is_for_sdk;
POGO_UNLESS_DEFINED char const pogosim_is_for_sdk = 0;
#else
extern char const pogosim_is_for_sdk __attribute__((weak));
#endif

struct pogosim_program const pogosim_this_program = {
    .interface_version = POGOSIM_VERSION_COMPILED,
    .main = robot_main,
    .user_data_bytes = &UserdataSize,
    .construct_user_data = &UserdataConstruct,
    .for_sdk = &pogosim_is_for_sdk,
};

// Functions of the C library that are the robot's own. Defined within the program, and seen only there, they are the
// ones that its code calls, whatever process it is loaded into.

POGO_WITHIN_PROGRAM int rand(void) {
    return pogosim_rand();
}

POGO_WITHIN_PROGRAM void srand(unsigned seed) {
    pogosim_srand(seed);
}

POGO_WITHIN_PROGRAM int usleep(unsigned microseconds) {
    pogosim_usleep((int)microseconds);
    return 0;
}

// Weak, since a file of the program that knows nothing of robots may have a function of this name.
__attribute__((weak)) POGO_WITHIN_PROGRAM unsigned sleep(unsigned seconds) {
    pogosim_sleep((int)seconds);
    return 0;
}

int __cxa_atexit(void (*destroy)(void*), void* object, void* library);
POGO_WITHIN_PROGRAM int __cxa_atexit(void (*destroy)(void*), void* object, void* library) {
    return pogosim_at_end(destroy, object, library);
}

// Whether a program has kept the symbols of its static variables is known by this one (program_symbols.cpp).
// After guard_process() of main.c, which must not run again; constructors of static objects come much later.
__attribute__((constructor(102))) static void before_constructors(void) {
    pogosim_srand(1);  // what constructors draw is the same each time that a process loads the program
    pogosim_before_constructors(&pogosim_this_program, before_constructors);
}
POGO_OWN_INITIALIZER(before_constructors)
#ifdef __APPLE__  // how the simulator knows a program when it is loaded
__attribute__((used, section("__DATA,pogo_program"))) static struct pogosim_program const* const this_program =
    &pogosim_this_program;
#endif

POGO_WITHIN_PROGRAM void exit(int status) {
    pogosim_exit(status);
}
