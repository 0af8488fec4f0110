#include "robot/caught_signals.hpp"

#include <array>
#include <cstddef>

namespace pogosim {

namespace {

constexpr std::size_t kSignals = 32;  // beyond are those for real-time programs
std::array<SignalHandler, kSignals> handlers{};

}  // namespace

void catch_signal(int signal, int flags, SignalHandler handler) {
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = flags | SA_NODEFER | SA_SIGINFO;
    action.sa_sigaction = handler;
    handlers.at(static_cast<std::size_t>(signal)) = handler;
    sigaction(signal, &action, nullptr);
}

void release_caught_signals() {
    for (std::size_t i = 0; i < handlers.size(); ++i) {
        auto const signal = static_cast<int>(i);
        struct sigaction now = {};
        if (handlers[i] != nullptr && sigaction(signal, nullptr, &now) == 0 && now.sa_sigaction == handlers[i]) {
            std::signal(signal, SIG_DFL);
        }
    }
}

}  // namespace pogosim
