#include "sim/interrupt.hpp"

#include <atomic>
#include <csignal>

#include "robot/user_guard.hpp"

namespace pogosim {

namespace {

std::atomic<bool> interrupt_seen = false;

void on_interrupt(int /*signal*/) {
    bool const again = interrupt_seen.exchange(true);
    if (again && inside_user_code()) {
        abandon_user_code("interrupted again before it returned", ExitCode::interrupted);
    }
}

}  // namespace

void catch_interrupts() {
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    action.sa_handler = on_interrupt;
    action.sa_flags = SA_RESTART | SA_NODEFER;
    for (int const signal : {SIGINT, SIGTERM, SIGXCPU}) {
        sigaction(signal, &action, nullptr);
    }
    // Under nohup the run goes on when the terminal is closed.
    struct sigaction before = {};
    sigaction(SIGHUP, nullptr, &before);
    if (before.sa_handler != SIG_IGN) {
        sigaction(SIGHUP, &action, nullptr);
    }
    // A reader of the console that has gone away is no reason to lose the data file.
    std::signal(SIGPIPE, SIG_IGN);
    // A file that may not grow further (ulimit -f) is an error of writing it.
    std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() {
    return interrupt_seen;
}

}  // namespace pogosim
