/// @file
/// Variables outside USERDATA: one for all simulated robots, but one for each real robot. `make sim` (and the tool
/// pogosim-shared-state) warns about each that the program could change, except those
///
///   - set from the configuration, with `init_from_configuration(variable)` and the like: the same on all robots;
///   - marked with #POGO_SHARED, i.e. shared intentionally.
#ifndef POGOSIM_SHARED_STATE_H
#define POGOSIM_SHARED_STATE_H

/// @cond
// What is between these may use __COUNTER__, which newer clang warns of with -Wpedantic where it is expanded.
#define POGO_WITH_COUNTER
#define POGO_WITHOUT_COUNTER
#ifdef __has_warning
#if __has_warning("-Wc2y-extensions")
#undef POGO_WITH_COUNTER
#undef POGO_WITHOUT_COUNTER
#define POGO_WITH_COUNTER _Pragma("clang diagnostic push") _Pragma("clang diagnostic ignored \"-Wc2y-extensions\"")
#define POGO_WITHOUT_COUNTER _Pragma("clang diagnostic pop")
#endif
#endif
/// @endcond

/// Marks a variable that simulated robots share intentionally, such as a count over the whole swarm for the data file:
///
///     POGO_SHARED uint32_t messages_of_all_robots;
///     POGO_SHARED static float table[256];   // every robot fills it with the same values
///
/// It has no effect on real robots. (g++ drops it for static variables in templates and, with -flto, in inline
/// functions.)
#ifdef REAL_ROBOT
#define POGO_SHARED
#elif defined(__APPLE__)
#define POGO_SHARED __attribute__((section("__DATA,pogo_shared")))
#else
// A section for each variable: constants, inline variables and others cannot be in one.
#define POGO_SHARED \
    POGO_WITH_COUNTER __attribute__((section("pogo_shared." POGO_TEXT_OF(__COUNTER__)))) POGO_WITHOUT_COUNTER
#define POGO_TEXT_OF(x) POGO_TEXT_OF_RAW(x)
#define POGO_TEXT_OF_RAW(x) #x
#endif

// Records in the program which variable a call reads from the configuration, for pogosim-shared-state: a constant with
// the text of the call's first argument, in the scope in which that text is valid.
#define POGO_NOTE_CONFIGURED(variable, ...) \
    __extension__({ static char const pogosim_configured[] __attribute__((used, unused)) = #variable; })

#endif
