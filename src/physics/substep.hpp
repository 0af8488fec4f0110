// A sub-step of an island, and the speeds of separation that its contacts demand.
#pragma once

#include <algorithm>
#include <limits>

#include "world/specs.hpp"

namespace pogosim {

/// Length of a sub-step, and what follows from it.
struct Times {
    float h_s;
    float rest_s;     // left of the whole step
    float per_h;      // 1/s
    float push_rate;  // speed at which a soft constraint pushes, per mm of overlap, 1/s
};

// Slower impacts are inelastic.
inline constexpr float kRestitutionThresholdMmS = 5.0F;
inline constexpr float kFastestPushMmS = 500.0F;
/// Overlaps up to this are left as they are; they count as no contact.
inline constexpr float kContactToleranceMm = 0.05F;
// Largest delay of an impact.
inline constexpr float kMostLateMm = 0.5F;

struct Demand {
    float least_mm_s;    // smallest speed of separation
    float relaxed_mm_s;  // the same after overlaps have been pushed apart
    float latest_mm_s;   // < 0; faster impacts cannot wait for the next sub-step
};

/// Things that meet within the sub-step bounce at once; others may close their gap. Those that overlap by more than the
/// tolerance are pushed apart, and lose that speed again when they have been moved. (Overlaps within the tolerance are
/// left alone: they are not counted as such, so nothing would take the speed back.) What is thrown against something
/// else in this sub-step bounces in the next one, unless it would be deep in it by then.
inline Demand demand_of(float gap_mm, float speed_mm_s, float restitution, Times const& times) {
    bool const is_free = gap_mm > 0.0F;
    bool const is_elastic = restitution > 0.0F;
    if (is_elastic && speed_mm_s < -kRestitutionThresholdMmS && gap_mm + speed_mm_s * times.h_s <= 0.0F) {
        float const bouncing_mm_s = std::min(-restitution * speed_mm_s, std::max(-speed_mm_s, kMostBounceMmS));
        return {bouncing_mm_s, bouncing_mm_s, std::numeric_limits<float>::max()};
    }
    float const meeting_mm_s = -gap_mm * times.per_h;
    bool const is_pushed = gap_mm < -kContactToleranceMm;
    float const pushed_mm_s = is_pushed ? std::min(-times.push_rate * gap_mm, kFastestPushMmS) : 0.0F;
    return {.least_mm_s = is_free ? meeting_mm_s : pushed_mm_s,
            .relaxed_mm_s = is_free ? meeting_mm_s : 0.0F,
            .latest_mm_s =
                is_elastic && is_free ? -(gap_mm + kMostLateMm) * times.per_h : std::numeric_limits<float>::max()};
}

}  // namespace pogosim
