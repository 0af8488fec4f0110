#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/exact_math.hpp"
#include "geometry/formations/ring_placement.hpp"

namespace pogosim {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kContactMargin = 1.0005F;  // rounding must not turn contact into overlap

/// How many disks fit side by side on a circle of `ring` times their radius.
int count_on_circle(int ring) {
    constexpr double rounding = 1.0e-3;
    return ring == 0 ? 1 : static_cast<int>(std::numbers::pi / exact::asin(1.0 / ring) + rounding);
}

/// Circles one radius apart.
RingPattern circles(Vec2 centre, float radius_mm) {
    float const step_mm = kContactMargin * radius_mm;
    auto const nodes = [centre, step_mm](int ring) {
        int const count = count_on_circle(ring);
        std::vector<Vec2> places;
        for (int i = 0; i < count; ++i) {
            float const angle_rad = 2.0F * kPi * static_cast<float>(i) / static_cast<float>(count);
            places.push_back(centre + step_mm * static_cast<float>(ring) * direction(angle_rad));
        }
        return places;
    };
    return {step_mm, nodes};
}

}  // namespace

std::vector<Placement> place_disk(PlacementTask const& task) {
    Vec2 const centre = formation_centre(task);
    // Objects without a size get their own circles nevertheless.
    double const room_mm2 = task.domain.area_mm2 / static_cast<double>(task.radii_mm.size());
    float const smallest_mm = 1.0e-2F * static_cast<float>(std::sqrt(room_mm2));
    auto const pattern_for = [&](float radius_mm) { return circles(centre, std::max(radius_mm, smallest_mm)); };
    return place_on_rings(task, centre, pattern_for, fmt::format("reduce nb, {}, or use power_lloyd", task.remedy));
}

}  // namespace pogosim
