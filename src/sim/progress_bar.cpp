#include "sim/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace pogosim {

namespace {

constexpr int kBarWidth = 40;
constexpr std::int64_t kStepsBetweenLooks = 16;  // the clock is not queried at every step
constexpr auto kRedrawPeriod = std::chrono::milliseconds(100);

}  // namespace

ProgressBar::ProgressBar(std::int64_t total, double time_step_s, bool enabled)
    : total_(std::max<std::int64_t>(total, 1)),
      time_step_s_(time_step_s),
      enabled_(enabled),
      terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressBar::show(std::int64_t done) {
    if (!enabled_ || done % kStepsBetweenLooks != 0) {
        return;
    }
    if (!terminal_) {
        if (done * 10 >= next_tenth_ * total_) {
            draw(done);
            next_tenth_ = done * 10 / total_ + 1;
        }
        return;
    }
    Clock::time_point const now = Clock::now();
    if (now - last_drawn_ >= kRedrawPeriod) {
        last_drawn_ = now;
        draw(done);
    }
}

void ProgressBar::finish(std::int64_t done) {
    if (enabled_) {
        if (done != last_shown_) {
            draw(done);
        }
        if (terminal_) {
            print("\n");
        }
    }
}

void ProgressBar::print(std::string const& text) {
    bool const written = std::fwrite(text.data(), 1, text.size(), stderr) == text.size();
    enabled_ = std::fflush(stderr) == 0 && written && enabled_;
}

void ProgressBar::draw(std::int64_t done) {
    last_shown_ = done;
    double const share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
    int const filled = static_cast<int>(share * kBarWidth);
    double const simulated_s = static_cast<double>(done) * time_step_s_;
    double const elapsed_s = std::chrono::duration<double>(Clock::now() - start_).count();
    print(fmt::format("{}[{}{}] {:3.0f} %  {:.1f} s simulated in {:.1f} s, {:.1f} x real time{}", terminal_ ? "\r" : "",
                      std::string(static_cast<std::size_t>(filled), '#'),
                      std::string(static_cast<std::size_t>(kBarWidth - filled), '.'), 100.0 * share, simulated_s,
                      elapsed_s, elapsed_s > 0.0 ? simulated_s / elapsed_s : 0.0, terminal_ ? " " : "\n"));
}

}  // namespace pogosim
