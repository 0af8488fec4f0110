#include "sim/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

#include "process/caught_signals.hpp"
#include "process/crash_handler.hpp"
#include "process/crash_message.hpp"

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
    SignalName{SIGXCPU, "SIGXCPU (processor time limit)"},
    SignalName{SIGUSR1, "SIGUSR1"},  // batch systems send these two some time before they kill
    SignalName{SIGUSR2, "SIGUSR2"},
    SignalName{SIGQUIT, "Ctrl-\\ (SIGQUIT)"},
};

char const* name_of(int signal) {
    for (SignalName const& interrupt : kInterrupts) {
        if (interrupt.signal == signal) {
            return interrupt.name;
        }
    }
    return "a signal";
}

sigset_t interrupts() {
    sigset_t set;
    sigemptyset(&set);
    for (SignalName const& interrupt : kInterrupts) {
        sigaddset(&set, interrupt.signal);
    }
    return set;
}

/// No data can be lost where no robot runs.
[[noreturn]] void end_outside_of_the_run(int signal) {
    prepare_interrupt_message(name_of(signal));
    end_with_crash_message(static_cast<int>(ExitCode::interrupted));
}

void on_interrupt(int signal, siginfo_t* /*info*/, void* /*context*/) {
    if (run_stage() != RunStage::running) {
        end_outside_of_the_run(signal);
    }
    if (note_interrupt(signal, name_of(signal)) > 2 && !inside_user_code()) {
        prepare_plain_message("interrupted three times; exiting immediately");
        end_with_crash_message(static_cast<int>(ExitCode::interrupted));
    }
}

/// Ignores a signal in this program, but not in its child programs.
void on_ignored_signal(int /*signal*/, siginfo_t* /*info*/, void* /*context*/) {}

/// The parent process may have set some signals to be ignored (nohup, a shell without job control).
bool may_be_ignored(int signal) {
    return signal != SIGINT && signal != SIGTERM && signal != SIGXCPU;
}

}  // namespace

void ignore_broken_outputs() {
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        if (fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) {
            open("/dev/null", O_RDWR);  // takes the lowest number that is free
        }
    }
    // A closed console pipe must not cost the data file, and exceeding the file size limit (ulimit -f) is a write
    // error.
    for (int const signal : {SIGPIPE, SIGXFSZ}) {
        catch_signal(signal, SA_RESTART, on_ignored_signal);
    }
}

void catch_interrupts() {
    for (SignalName const& interrupt : kInterrupts) {
        struct sigaction before = {};
        sigaction(interrupt.signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN || !may_be_ignored(interrupt.signal)) {
            catch_signal(interrupt.signal, SA_RESTART, on_interrupt);
        }
    }
}

void hold_interrupts() {
    sigset_t const set = interrupts();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

void release_interrupts() {
    sigset_t const set = interrupts();
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace pogosim
