// The variables of this process's environment, as "NAME=value"; the last one is null.
#pragma once

#ifdef __APPLE__
#include <crt_externs.h>  // libraries do not see the variable itself
#else
#include <unistd.h>
#endif

namespace pogosim {

inline char** environment() {
#ifdef __APPLE__
    return *_NSGetEnviron();
#else
    return environ;
#endif
}

}  // namespace pogosim
