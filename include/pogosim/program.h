/// @file
/// What the simulator knows of a program. Every program contains one such structure, from libpogosim_program;
/// executables pass theirs to the simulator, and a shared object is looked at for it when it is loaded.
#ifndef POGOSIM_PROGRAM_H
#define POGOSIM_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

struct pogosim_program {
    uint32_t interface_version;           ///< POGOSIM_VERSION_COMPILED of what it is linked with
    int (*main)(void);                    ///< the program's main(), which the headers rename
    size_t const* user_data_bytes;        ///< size of USERDATA; 0 without REGISTER_USERDATA
    void (**construct_user_data)(void*);  ///< constructs USERDATA in C++ programs; NULL in others
    char const* for_sdk;  ///< of the robots' SDK (pogobot.h), if it is 1: main() does not return. May be NULL
};

/// The structure of the program that contains it.
extern struct pogosim_program const pogosim_this_program;

/// Runs a program as its command line says: what main() of an executable does. Returns the exit code.
int pogosim_run_program(struct pogosim_program const* program, int argc, char** argv);

/// Lets the simulator report crashes and interrupts from now on, also those before main(): for executables alone.
void pogosim_guard_process(void);

/// The program's variables are as its file says: what constructs static objects in C++ runs after `self`, which has
/// called this, among the functions that run before main(). Those may run again, for each robot that has variables of
/// its own.
void pogosim_before_constructors(struct pogosim_program const* program, void (*self)(void));

/// On macOS, where such functions run in another order, says that a function before main() is of the simulator, and has
/// no part in that.
#ifdef __APPLE__
#define POGO_OWN_INITIALIZER(function) \
    __attribute__((used, section("__DATA,pogo_own"))) static void (*const own_##function)(void) = function;
#else
#define POGO_OWN_INITIALIZER(function)
#endif

/// In C++: calls `destroy(object)`, for a static object, when the process ends or `library` leaves memory; never for an
/// object of a robot that has variables of its own. Returns 0 unless memory is short.
int pogosim_at_end(void (*destroy)(void*), void* object, void* library);

// Replacements of rand(), srand(), exit(), usleep() and sleep(), which a program's calls reach.
int pogosim_rand(void);
void pogosim_srand(unsigned seed);
void pogosim_exit(int status) __attribute__((noreturn));
void pogosim_usleep(int microseconds);
void pogosim_sleep(int seconds);

struct pogosim_slip_descriptor;
/// What raw packets are sent with (slip.h). Programs declare it themselves.
extern struct pogosim_slip_descriptor const slip_send_descriptor;

/// A program that declares `mydata` by hand, as a pointer like any other, says where it is. It points to the user data
/// of the robot that runs.
void pogosim_give_mydata(void** mydata);

/// Replaces msleep() at the end of a tick in the simulator's main loop, after which nothing of the tick is left to do.
void pogosim_sleep_after_tick(int milliseconds);

/// The robot's program reads its clock, which takes time if it does so again and again.
void pogosim_let_time_pass(void);

/// The main loop has called a function: on the robot, this takes time.
void pogosim_take_time_of(void (*function)(void));
/// It has called user_step in a tick, or there is none (null).
void pogosim_take_time_of_tick(void (*user_step)(void));

/// Calls msg_tx_fn for the main loop, and notes whether it sends what it says.
bool pogosim_call_msg_tx_fn(bool (*send)(void));

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
