#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "geometry/formations/disk_field.hpp"
#include "geometry/formations/task.hpp"

namespace pogosim {

namespace {

constexpr float kWallClearance = 1.1F;    // times the placement radius
constexpr int kTriesPerCandidate = 1000;  // points drawn until one is far enough from the walls

class RandomPlacement {
public:
    explicit RandomPlacement(PlacementTask const& task)
        : task_(task), order_(largest_first(task.radii_mm)), field_(task.domain.bounds, task.radii_mm) {
        // A limit that the whole arena is within is none.
        if (task.spec.max_space_mm < length(task.domain.bounds.size())) {
            reach_mm_ = task.spec.max_space_mm;
            check_reach();
        }
    }

    std::vector<Placement> run() {
        repeat_until_all_stand(task_, points_drawn_, [this] { return try_once(); });
        std::vector<Placement> placements(order_.size());
        for (std::size_t k = 0; k < order_.size(); ++k) {
            placements[order_[k]] = {placed_[k], kHeadingToDraw};
        }
        return placements;
    }

private:
    void check_reach() const {
        float const smallest = *std::ranges::min_element(task_.radii_mm);
        if (*reach_mm_ < 2.0F * smallest) {
            throw FormationError("formation_max_space_between_neighbors",
                                 fmt::format("{:g} mm is less than the {:g} mm that "
                                             "two of the smallest objects keep between their centres",
                                             *reach_mm_, 2.0F * smallest));
        }
    }

    /// Places until all stand or one does not fit; returns how many stand.
    std::size_t try_once() {
        field_.clear();
        placed_.clear();
        for (std::uint32_t const object : order_) {
            std::optional<Vec2> const place = find_place(task_.radii_mm[object]);
            if (!place) {
                break;
            }
            field_.put(object, *place);
            placed_.push_back(*place);
        }
        return placed_.size();
    }

    std::optional<Vec2> find_place(float radius_mm) {
        for (int attempt = 0; attempt < task_.spec.attempts_per_point; ++attempt) {
            std::optional<Vec2> const candidate = draw_candidate(radius_mm);
            if (!candidate || field_.is_free(*candidate, radius_mm)) {
                return candidate;
            }
        }
        return std::nullopt;
    }

    /// A point far enough from the walls, if there is hope to find one, and, with a largest distance asked for, near
    /// one already placed.
    std::optional<Vec2> draw_candidate(float radius_mm) {
        for (int i = 0; i < kTriesPerCandidate && points_drawn_ < kMostPointsDrawn; ++i) {
            ++points_drawn_;
            Vec2 const point =
                reach_mm_ && !placed_.empty() ? draw_near_some() : task_.space.random_point(task_.random);
            if (task_.space.holds(point, kWallClearance * radius_mm)) {
                return point;
            }
        }
        return std::nullopt;
    }

    Vec2 draw_near_some() {
        Vec2 const neighbour = placed_[task_.random.below(static_cast<std::uint32_t>(placed_.size()))];
        float const distance_mm = *reach_mm_ * std::sqrt(task_.random.uniform());
        return neighbour + distance_mm * direction(task_.random.uniform(0.0F, 2.0F * std::numbers::pi_v<float>));
    }

    PlacementTask const& task_;
    std::vector<std::uint32_t> order_;
    DiskField field_;
    std::optional<float> reach_mm_;
    std::vector<Vec2> placed_;  // in `order_`
    std::int64_t points_drawn_ = 0;
};

}  // namespace

std::vector<Placement> place_random(PlacementTask const& task) {
    return RandomPlacement(task).run();
}

}  // namespace pogosim
