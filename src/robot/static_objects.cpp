// Static objects of programs in C++ are destroyed at the end of the process, but for those of robots.
#include "robot/static_objects.hpp"

#include <dlfcn.h>

#include <atomic>

#include "pogosim/program.h"
#include "robot/context.hpp"

namespace pogosim {

namespace {
std::atomic<unsigned> registered = 0;
}

unsigned functions_at_end() {
    return registered;
}

}  // namespace pogosim

int pogosim_at_end(void (*destroy)(void*), void* object, void* library) {
    // A robot's program does not end, and its objects are no longer in place when the process does.
    if (pogosim::context.controller != nullptr && pogosim::context.has_own_memory) {
        return 0;
    }
    ++pogosim::registered;
    // Found by name: in an executable that contains this library, a plain call would reach the program's own function,
    // which calls this one.
    using AtEnd = int (*)(void (*)(void*), void*, void*);
    static auto const of_library = reinterpret_cast<AtEnd>(dlsym(RTLD_DEFAULT, "__cxa_atexit"));
    return of_library(destroy, object, library);
}
