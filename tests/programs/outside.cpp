// A program that does something on demand where no robot has the processor: before main(), after the run, in a thread
// or in a child process. The environment says what, as main() is not there to read a configuration.
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "pogobase.h"

namespace {

bool asked_for(char const* place, char const* kind) {
    char const* const chosen_place = std::getenv("PLACE");
    char const* const chosen_kind = std::getenv("KIND");
    return chosen_place != nullptr && chosen_kind != nullptr && std::strcmp(chosen_place, place) == 0 &&
           std::strcmp(chosen_kind, kind) == 0;
}

POGO_SHARED int* volatile nowhere = nullptr;
POGO_SHARED volatile int zero = 0;

int sum_on_the_stack(int depth) {
    volatile int frame[1024];
    frame[0] = depth;
    return depth == zero ? 0 : sum_on_the_stack(depth + 1) + frame[0];
}

void fork_and_wait();

void misbehave(char const* place) {
    if (asked_for(place, "crash")) {
        *nowhere = 1;
    } else if (asked_for(place, "divide")) {
        zero = 7 / zero;
    } else if (asked_for(place, "abort")) {
        std::abort();
    } else if (asked_for(place, "throw")) {
        throw std::runtime_error("no air");
    } else if (asked_for(place, "overflow")) {
        zero = sum_on_the_stack(1);
    } else if (asked_for(place, "exit")) {
        std::exit(5);
    } else if (asked_for(place, "pthread_exit")) {
        pthread_exit(nullptr);
    } else if (asked_for(place, "fork")) {
        fork_and_wait();
    } else if (asked_for(place, "print")) {
        printf("printed %lu times\n", 1UL);
    } else if (asked_for(place, "seed")) {
        srand(static_cast<unsigned>(pogobot_helper_getRandSeed()));
    } else if (asked_for(place, "led")) {
        pogobot_led_setColor(1, 2, 3);
    } else if (asked_for(place, "stop")) {
        stop_simulation();
    } else if (asked_for(place, "category")) {
        printf("%s\n", get_current_robot_category());
    } else if (asked_for(place, "milliseconds")) {
        zero = static_cast<int>(current_time_milliseconds());
    }
}

struct Static {
    Static() { misbehave("constructor"); }
    ~Static() noexcept(false) { misbehave("destructor"); }
};
POGO_SHARED Static of_the_program;

__attribute__((constructor)) void before_main() {
    misbehave("function before main");
}

__attribute__((destructor)) void after_main() {
    misbehave("function after main");
}

void at_exit() {
    misbehave("atexit");
}

void fork_and_wait() {
    pid_t const child = fork();
    if (child == 0) {
        printf("the child prints\n");
        misbehave("child");
        if (!asked_for("child", "return")) {
            _exit(6);
        }
        return;
    }
    int status = 0;
    waitpid(child, &status, 0);
    printf("the child ended with %d\n", WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status));
}

void user_step() {
    if (pogobot_ticks == 0) {
        printf("first tick\n");
    }
    if (pogobot_ticks != 10 || pogobot_helper_getid() != 1) {
        return;
    }
    char const* const place = std::getenv("PLACE");
    if (place == nullptr) {
        return;
    }
    if (std::strcmp(place, "thread") == 0) {
        std::thread([] { misbehave("thread"); }).join();
    } else if (std::strcmp(place, "lone thread") == 0) {
        std::thread([] { misbehave("lone thread"); }).detach();
    } else if (std::strcmp(place, "child") == 0) {
        printf("before the fork\n");
        fork_and_wait();
    }
}

}  // namespace

int main() {
    POGO_SHARED static bool registered = false;
    if (!registered) {
        registered = true;
        std::atexit(at_exit);
    }
    pogobot_init();
    pogobot_start(nullptr, user_step);
    return 0;
}
