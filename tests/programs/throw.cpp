// A C++ program whose robot 1 throws an exception that is not caught, in its tenth tick.
#include <stdexcept>
#include <string>

#include "pogobase.h"

struct Userdata {};
DECLARE_USERDATA(Userdata);
REGISTER_USERDATA(Userdata);

void user_init() {}

void user_step() {
    if (pogobot_helper_getid() == 1 && pogobot_ticks == 10) {
        throw std::runtime_error("a tyre is flat");
    }
}

extern "C" int main() {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
