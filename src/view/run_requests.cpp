#include "view/run_requests.hpp"

#include <algorithm>
#include <variant>

namespace pogosim {

namespace {

constexpr double kSlowest = 1e-3;  // that the keys ask for
constexpr double kFastest = 1e6;
constexpr double kUnlimitedSlower =
    10.0;  // speed after "slower" from no limit, while the reached speed is not known yet

}  // namespace

void RunRequests::take(RunStatus const& newest) {
    // Only the user changes these two, and the moment may be from before the simulation has taken notice.
    RunStatus const asked = status_;
    status_ = newest;
    // A condition pauses the run, too: once, since the moments that say so may be older than an answer of the user.
    bool const was_stopped = !newest.why_paused.empty() && asked.why_paused.empty();
    status_.paused = asked.paused || was_stopped;
    status_.asked_speed_up = asked.asked_speed_up;
}

std::string RunRequests::send(Command const& command) {
    bool const needs_the_run = std::holds_alternative<Pause>(command) || std::holds_alternative<StepOnce>(command);
    if (status_.is_over && needs_the_run) {
        return "the run is over: R runs it again";
    }
    if (auto const* const pause = std::get_if<Pause>(&command)) {
        status_.paused = pause->on;
    } else if (std::holds_alternative<GoBack>(command) || std::holds_alternative<StepOnce>(command)) {
        status_.paused = true;
    } else if (auto const* const speed = std::get_if<SetSpeedUp>(&command)) {
        status_.asked_speed_up = speed->factor;
    }
    exchange_.send(command);
    return "";
}

void RunRequests::change_speed(double factor) {
    double const asked = status_.asked_speed_up;
    if (asked > 0.0) {
        send(SetSpeedUp{std::clamp(asked * factor, std::min(asked, kSlowest), std::max(asked, kFastest))});
    } else if (factor < 1.0) {
        double const reached = status_.speed_up;
        send(SetSpeedUp{reached > 0.0 ? reached * factor : kUnlimitedSlower});
    }
}

}  // namespace pogosim
