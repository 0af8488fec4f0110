#include "view/lost_display.hpp"

#include <dlfcn.h>

namespace pogosim {

namespace {

struct Display;  // Xlib's
sigjmp_buf* jump_point = nullptr;

int on_lost_connection(Display* /*display*/) {
    siglongjmp(*jump_point, 1);
}

/// Xlib's own one ends the program. An error of one request, such as for a window that is just closing, does no harm.
int on_error(Display* /*display*/, void* /*error*/) {
    return 0;
}

}  // namespace

void jump_when_display_is_lost(sigjmp_buf& point) {
    // SDL loads the library; linking it would make every window need X.
    void* const xlib = dlopen("libX11.so.6", RTLD_NOW);
    if (xlib == nullptr) {
        return;
    }
    jump_point = &point;
    using SetLostHandler = void* (*)(int (*)(Display*));
    using SetErrorHandler = void* (*)(int (*)(Display*, void*));
    if (auto const set = reinterpret_cast<SetLostHandler>(dlsym(xlib, "XSetIOErrorHandler"))) {
        set(on_lost_connection);
    }
    if (auto const set = reinterpret_cast<SetErrorHandler>(dlsym(xlib, "XSetErrorHandler"))) {
        set(on_error);
    }
}

}  // namespace pogosim
