#include "sim/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>

#include "robot/last_words.hpp"
#include "robot/user_guard.hpp"

namespace pogosim {

namespace {

struct SignalName {
    int signal;
    char const* name;
};
constexpr std::array kInterrupts{
    SignalName{SIGINT, "Ctrl-C (SIGINT)"},
    SignalName{SIGTERM, "SIGTERM"},
    SignalName{SIGHUP, "SIGHUP (the terminal was closed)"},
    SignalName{SIGXCPU, "SIGXCPU (the limit of processor time)"},
};

// timeout(1) and batch systems send a signal to the process and to its group: it may come twice at once.
constexpr double kSameRequestS = 0.1;

std::atomic<int> interrupts_seen = 0;
std::atomic<double> last_seen_s = 0.0;

char const* name_of(int signal) {
    for (SignalName const& interrupt : kInterrupts) {
        if (interrupt.signal == signal) {
            return interrupt.name;
        }
    }
    return "a signal";
}

/// Before the first robot runs nothing is lost.
[[noreturn]] void end_before_the_run(int signal) {
    SignalText<256> text;
    text << "pogosim: " << name_of(signal) << " before the first robot ran: there is no data file of this run.\n";
    text.write_to_stderr();
    _exit(static_cast<int>(ExitCode::interrupted));
}

void on_interrupt(int signal) {
    if (!is_signal_for_this_thread(signal)) {
        return;
    }
    if (run_stage() == RunStage::preparing) {
        end_before_the_run(signal);
    }
    double const now_s = monotonic_s();
    bool const same = interrupts_seen > 0 && now_s - last_seen_s < kSameRequestS;
    last_seen_s = now_s;
    if (same) {
        return;
    }
    int const count = ++interrupts_seen;
    if (count == 1) {
        hurry_user_code(name_of(signal));
    } else {
        abandon_user_code();
    }
    if (count > 2 && !inside_user_code()) {
        prepare_plain_last_words("interrupted three times, so the program ends at once");
        end_with_last_words(static_cast<int>(ExitCode::interrupted));
    }
}

/// Ignores a signal in this program, but not in those that it starts.
void on_ignored_signal(int /*signal*/) {}

}  // namespace

void ignore_broken_outputs() {
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        if (fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) {
            open("/dev/null", O_RDWR);  // takes the lowest number that is free
        }
    }
    // A reader of the console that has gone away is no reason to lose the data file, and a file that may not grow
    // further (ulimit -f) is an error of writing it.
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART | SA_NODEFER;
    action.sa_handler = on_ignored_signal;
    for (int const signal : {SIGPIPE, SIGXFSZ}) {
        sigaction(signal, &action, nullptr);
    }
}

void catch_interrupts() {
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART | SA_NODEFER;
    action.sa_handler = on_interrupt;
    for (SignalName const& interrupt : kInterrupts) {
        struct sigaction before = {};
        sigaction(interrupt.signal, nullptr, &before);
        // Under nohup the run goes on when the terminal is closed.
        if (interrupt.signal != SIGHUP || before.sa_handler != SIG_IGN) {
            sigaction(interrupt.signal, &action, nullptr);
        }
    }
}

void release_interrupts() {
    for (SignalName const& interrupt : kInterrupts) {
        struct sigaction now = {};
        sigaction(interrupt.signal, nullptr, &now);
        if (now.sa_handler == on_interrupt) {
            std::signal(interrupt.signal, SIG_DFL);
        }
    }
}

bool interrupted() {
    return interrupts_seen > 0;
}

}  // namespace pogosim
