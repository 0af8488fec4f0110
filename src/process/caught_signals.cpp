#include "process/caught_signals.hpp"

#include <array>
#include <cstddef>

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
    return caught(signal).handler != nullptr && sigaction(signal, nullptr, &now) == 0 &&
           now.sa_sigaction == caught(signal).handler;
}

}  // namespace

void catch_signal(int signal, int flags, SignalHandler handler) {
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = flags | SA_NODEFER | SA_SIGINFO;
    action.sa_sigaction = handler;
    struct sigaction before = {};
    bool const again = is_still_ours(signal);
    caught(signal).handler = handler;
    sigaction(signal, &action, &before);
    if (!again) {
        caught(signal).before = before;
    }
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

void pass_on(int signal, siginfo_t* info, void* context) {
    struct sigaction const& before = caught(signal).before;
    if (before.sa_handler == SIG_IGN) {
        return;
    }
    if (before.sa_handler == SIG_DFL) {
        std::signal(signal, SIG_DFL);
        if (info->si_code <= 0) {  // sent: it does not come again by itself, as a crash does
            std::raise(signal);
        }
    } else if ((before.sa_flags & SA_SIGINFO) != 0) {
        before.sa_sigaction(signal, info, context);
    } else {
        before.sa_handler(signal);
    }
}

void release_caught_signals() {
    for (std::size_t i = 0; i < signals.size(); ++i) {
        if (is_still_ours(static_cast<int>(i))) {
            std::signal(static_cast<int>(i), SIG_DFL);
        }
    }
}

}  // namespace pogosim
