// A line on stderr that shows the progress of a run.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace pogosim {

class ProgressBar {
public:
    /// `total` steps. Disabled bars do nothing. On a terminal, the line is redrawn in place ten times per second;
    /// otherwise a line is printed after each tenth of the run. Nothing is drawn once stderr is broken.
    ProgressBar(std::int64_t total, double time_step_s, bool enabled);

    void show(std::int64_t done);

    /// Keeps the line and moves to the next.
    void finish(std::int64_t done);

private:
    using Clock = std::chrono::steady_clock;

    void draw(std::int64_t done);
    void print(std::string const& text);

    std::int64_t total_;
    double time_step_s_;
    bool enabled_;
    bool terminal_;
    std::int64_t last_shown_ = -1;
    std::int64_t next_tenth_ = 1;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_drawn_ = start_;
};

}  // namespace pogosim
