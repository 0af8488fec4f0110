#include "process/caught_signals.hpp"

#include <unistd.h>

#include <array>
#include <cstddef>
#include <string_view>

namespace pogosim {

namespace {

struct Caught {
    SignalHandler handler = nullptr;  // null: not caught
    struct sigaction before = {};
};

constexpr std::size_t kSignals = 32;  // beyond are those for real-time programs
std::array<Caught, kSignals> signals;

Caught& caught(int signal) {
    return signals.at(static_cast<std::size_t>(signal));
}

bool is_still_ours(int signal) {
    struct sigaction now = {};
    return is_caught(signal) && sigaction(signal, nullptr, &now) == 0 && now.sa_sigaction == caught(signal).handler;
}

/// A signal that this thread is passing on.
struct PassedOn {
    int signal = 0;
    void const* frame = nullptr;  // of the function that does
};
constinit thread_local PassedOn passed_on;

/// Whether a handler to which a crash was passed on has sent it here again: it has taken ours for the one before it.
bool comes_back(int signal, void const* frame) {
    constexpr std::ptrdiff_t most_bytes = 65536;
    std::ptrdiff_t const deeper = static_cast<char const*>(passed_on.frame) - static_cast<char const*>(frame);
    return signal == passed_on.signal && deeper > 0 && deeper < most_bytes;  // else it was left by a jump
}

}  // namespace

void catch_signal(int signal, int flags, SignalHandler handler) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    // After it was given back, the host may have restored it.
    bool const again =
        before.sa_sigaction == handler || (is_caught(signal) && before.sa_sigaction == caught(signal).handler);
    // All is known before the handler is there: a signal often arrives as the call that installs it returns.
    if (!again) {
        caught(signal).before = before;
    }
    caught(signal).handler = handler;
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = flags | SA_NODEFER | SA_SIGINFO;
    action.sa_sigaction = handler;
    sigaction(signal, &action, nullptr);
}

bool is_caught(int signal) {
    return caught(signal).handler != nullptr;
}

bool has_handler_before(int signal) {
    auto* const before = caught(signal).before.sa_handler;
    return is_caught(signal) && before != SIG_DFL && before != SIG_IGN;
}

void give_back_signal(int signal) {
    if (caught(signal).handler == nullptr) {
        return;
    }
    struct sigaction now = {};
    sigaction(signal, &caught(signal).before, &now);
    if (now.sa_sigaction != caught(signal).handler) {
        sigaction(signal, &now, nullptr);  // the program has taken it
    }
    caught(signal).handler = nullptr;
}

namespace {

/// From a handler; a shell says it only of programs that it runs in the foreground.
void say_ended_by_alarm() {
    constexpr std::string_view kLine =
        "Error: ended by an alarm that the program or its host has set (alarm(), setitimer(), timer_create()) and does "
        "not handle\n";
    [[maybe_unused]] ssize_t const ignored = write(STDERR_FILENO, kLine.data(), kLine.size());
}

}  // namespace

void pass_on(int signal, siginfo_t* info, void* context) {
    struct sigaction const& before = caught(signal).before;
    bool const is_alarm = signal == SIGALRM || signal == SIGPROF;
    // A handler that took ours for the one before it, which was given back since, calls it none the less. A signal may
    // also have been on its way here while another thread gave it back.
    bool const is_stale = !is_caught(signal);
    bool const has_handler = before.sa_handler != SIG_DFL && before.sa_handler != SIG_IGN;
    if (before.sa_handler == SIG_IGN || (is_stale && is_alarm && !has_handler)) {
        return;
    }
    void const* const frame = __builtin_frame_address(0);
    if (!has_handler || (is_stale && !is_alarm) || comes_back(signal, frame)) {
        std::signal(signal, SIG_DFL);
        if (is_alarm) {
            say_ended_by_alarm();
        }
        if (is_alarm || info->si_code <= 0) {  // sent: it does not come again by itself, as a crash does
            std::raise(signal);
        }
        return;
    }
    PassedOn const outer = passed_on;
    passed_on = {.signal = signal, .frame = frame};
    if ((before.sa_flags & SA_SIGINFO) != 0) {
        before.sa_sigaction(signal, info, context);
    } else {
        before.sa_handler(signal);
    }
    passed_on = outer;
}

void release_caught_signals() {
    for (std::size_t i = 0; i < signals.size(); ++i) {
        if (is_still_ours(static_cast<int>(i))) {
            std::signal(static_cast<int>(i), SIG_DFL);
            signals.at(i).handler = nullptr;
        }
    }
}

}  // namespace pogosim
