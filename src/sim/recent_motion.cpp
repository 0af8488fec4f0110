#include "sim/recent_motion.hpp"

#include <algorithm>

#include "world/observed_motion.hpp"

namespace pogosim {

namespace {

constexpr double kSamplePeriodS = 0.02;

}  // namespace

RecentMotion::RecentMotion(World const& world)
    : object_(world.robots.size()), now_{.time_s = world.time_s(), .way_mm = std::vector<Vec2>(world.robots.size())} {
    for (std::uint32_t i = 0; i < world.objects.size(); ++i) {
        if (std::uint32_t const robot = world.objects[i].robot; robot != kNone) {
            object_[robot] = i;
        }
    }
    samples_.push_back(now_);
}

void RecentMotion::follow(World const& world) {
    auto const step_s = static_cast<float>(world.time_step_s);
    for (std::size_t robot = 0; robot < object_.size(); ++robot) {
        Object const& object = world.objects[object_[robot]];
        now_.way_mm[robot] = now_.way_mm[robot] + step_s * observed_motion(world, object).velocity_mm_s;
    }
    now_.time_s = world.time_s();
    if (now_.time_s - samples_.back().time_s < kSamplePeriodS * (1.0 - kWholeTolerance)) {
        return;
    }
    samples_.push_back(now_);
    while (samples_.size() > 2 && samples_[1].time_s <= now_.time_s - kWindowS) {
        samples_.pop_front();
    }
}

RecentMotion::Displacement RecentMotion::of(std::uint32_t robot, double window_s) const {
    double const start_s = std::max(now_.time_s - window_s, samples_.front().time_s);
    auto const after = std::ranges::find_if(samples_, [&](Sample const& sample) { return sample.time_s > start_s; });
    Sample const& next = after != samples_.end() ? *after : now_;
    Sample const& before = after != samples_.begin() ? *(after - 1) : samples_.front();
    double const interval_s = next.time_s - before.time_s;
    double const share = interval_s > 0.0 ? (start_s - before.time_s) / interval_s : 0.0;
    Vec2 const start_mm =
        before.way_mm[robot] + static_cast<float>(share) * (next.way_mm[robot] - before.way_mm[robot]);
    return {.distance_mm = length(now_.way_mm[robot] - start_mm), .during_s = now_.time_s - start_s};
}

}  // namespace pogosim
