#include "geometry/formations/task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pogosim {

std::vector<std::uint32_t> largest_first(std::span<float const> radii_mm) {
    std::vector<std::uint32_t> order(radii_mm.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) { return radii_mm[a] > radii_mm[b]; });
    return order;
}

std::string describe_objects(PlacementTask const& task) {
    float const largest = *std::ranges::max_element(task.radii_mm) / kPlacementMargin;
    return fmt::format("{} object{} (largest radius {:.4g} mm)", task.radii_mm.size(),
                       task.radii_mm.size() == 1 ? "" : "s", largest);
}

void repeat_until_all_stand(PlacementTask const& task, std::int64_t const& points_drawn,
                            std::function<std::size_t()> const& try_once) {
    std::size_t most = 0;
    for (int restarts = 0;; ++restarts) {
        std::size_t const placed = try_once();
        if (placed == task.radii_mm.size()) {
            return;
        }
        most = std::max(most, placed);
        if (points_drawn >= kMostPointsDrawn || restarts == task.spec.max_restarts) {
            throw FormationError(
                kFormationKey,
                fmt::format("'{}' could place only {} of {} in this {} after {} restarts; reduce nb, {}, or use "
                            "power_lloyd",
                            task.spec.name, most, describe_objects(task), task.ground, restarts, task.remedy));
        }
    }
}

Vec2 formation_centre(PlacementTask const& task) {
    Vec2 const middle = centroid(task.domain.outer());
    Vec2 const asked = task.spec.centre_mm;
    Vec2 const centre{std::isnan(asked.x) ? middle.x : asked.x, std::isnan(asked.y) ? middle.y : asked.y};
    if (!task.domain.bounds.contains(centre)) {
        throw FormationError("initial_formation_center",
                             fmt::format("({:g}, {:g}) is outside {}", centre.x, centre.y, arena_text(task.domain)));
    }
    return centre;
}

}  // namespace pogosim
