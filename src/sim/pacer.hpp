// Keeps a run at a speed that can be watched.
#pragma once

#include <chrono>
#include <optional>

namespace pogosim {

class Pacer {
public:
    using Clock = std::chrono::steady_clock;

    /// `speed_up`: simulated seconds per second; 0: no limit.
    explicit Pacer(double speed_up) : speed_up_(speed_up) {}

    double speed_up() const { return speed_up_; }
    void set_speed_up(double speed_up);

    /// Forgets how late the run is: after a pause, or a step during which the run was stopped.
    void start_anew();

    /// When the step of `step_s` that begins at `time_s` may be made: when the time of its end has come. A run that is
    /// late by more than a moment does not catch up.
    Clock::time_point due(double time_s, double step_s, Clock::time_point now);

    /// A step has ended at `time_s`.
    void note_step(double time_s, Clock::time_point now);

    /// Simulated seconds per second over the last half second to second; 0: not known yet.
    double reached() const { return reached_; }

    /// The asked speed could not be kept in that time.
    bool is_too_slow() const;

private:
    struct Mark {
        Clock::time_point wall;
        double time_s = 0.0;
    };

    double speed_up_;
    std::optional<Mark> start_;     // of the present pace
    std::optional<Mark> measured_;  // where the present measurement began
    double reached_ = 0.0;
};

}  // namespace pogosim
