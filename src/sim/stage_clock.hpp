// Wall-clock time taken by each stage of the steps, for benchmarks. It does not affect results.
#pragma once

#include <array>
#include <chrono>
#include <string_view>

namespace pogosim {

enum class Stage { light, robots, messages, physics, record };
inline constexpr std::array<std::string_view, 5> kStageNames{"light", "robots", "messages", "physics", "record"};

class StageClock {
public:
    explicit StageClock(bool enabled) : enabled_(enabled) {}

    void begin_step() {
        if (enabled_) {
            last_ = Clock::now();
        }
    }

    /// The time since the last call belongs to this stage.
    void end(Stage stage) {
        if (enabled_) {
            Clock::time_point const now = Clock::now();
            spent_s_[static_cast<std::size_t>(stage)] += std::chrono::duration<double>(now - last_).count();
            last_ = now;
        }
    }

    double spent_s(Stage stage) const { return spent_s_[static_cast<std::size_t>(stage)]; }

private:
    using Clock = std::chrono::steady_clock;

    bool enabled_;
    Clock::time_point last_;
    std::array<double, kStageNames.size()> spent_s_{};
};

}  // namespace pogosim
