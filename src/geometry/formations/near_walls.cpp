#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <optional>
#include <vector>

#include "geometry/formations/disk_field.hpp"
#include "geometry/formations/task.hpp"

namespace pogosim {

namespace {

constexpr float kWallDistance = 1.5F;      // of the first layer, times the placement radius
constexpr float kContactMargin = 1.0005F;  // rounding must not turn contact into overlap

/// Layer 0 stands along the walls; layer k + 1 touches layer k. A layer is full when as many draws in a row as
/// `attempts_per_point` found no place.
class WallPlacement {
public:
    explicit WallPlacement(PlacementTask const& task)
        : task_(task),
          order_(largest_first(task.radii_mm)),
          field_(task.domain.bounds, task.radii_mm),
          places_(task.radii_mm.size()) {}

    std::vector<Placement> run() {
        repeat_until_all_stand(task_, points_drawn_, [this] { return try_once(); });
        std::vector<Placement> placements;
        std::ranges::transform(places_, std::back_inserter(placements), [](Vec2 place) {
            return Placement{place, kHeadingToDraw};
        });
        return placements;
    }

private:
    /// Places until all stand or one does not fit; returns how many stand.
    std::size_t try_once() {
        field_.clear();
        inner_layer_.clear();
        outer_layer_.clear();
        on_walls_ = true;
        for (std::size_t k = 0; k < order_.size(); ++k) {
            std::uint32_t const object = order_[k];
            std::optional<Vec2> const place = find_place(task_.radii_mm[object]);
            if (!place) {
                return k;
            }
            field_.put(object, *place);
            places_[object] = *place;
            outer_layer_.push_back(object);
        }
        return order_.size();
    }

    std::optional<Vec2> find_place(float radius_mm) {
        while (true) {
            if (auto const place = find_place_in_layer(radius_mm)) {
                return place;
            }
            if (outer_layer_.empty()) {
                return std::nullopt;
            }
            inner_layer_ = std::move(outer_layer_);
            outer_layer_.clear();
            on_walls_ = false;
        }
    }

    std::optional<Vec2> find_place_in_layer(float radius_mm) {
        for (int attempt = 0; attempt < task_.spec.attempts_per_point && points_drawn_ < kMostPointsDrawn; ++attempt) {
            ++points_drawn_;
            Vec2 const point = on_walls_ ? task_.space.random_point_along_walls(kWallDistance * radius_mm, task_.random)
                                         : draw_in_contact(radius_mm);
            if (task_.space.holds(point, radius_mm) && field_.is_free(point, radius_mm)) {
                return point;
            }
        }
        return std::nullopt;
    }

    Vec2 draw_in_contact(float radius_mm) {
        std::uint32_t const support = inner_layer_[task_.random.below(static_cast<std::uint32_t>(inner_layer_.size()))];
        float const distance_mm = kContactMargin * (radius_mm + task_.radii_mm[support]);
        return places_[support] + distance_mm * direction(task_.random.uniform(0.0F, 2.0F * std::numbers::pi_v<float>));
    }

    PlacementTask const& task_;
    std::vector<std::uint32_t> order_;
    DiskField field_;
    std::vector<Vec2> places_;                // by object
    std::vector<std::uint32_t> inner_layer_;  // what the next ones touch, off the walls
    std::vector<std::uint32_t> outer_layer_;  // the layer being filled
    bool on_walls_ = true;
    std::int64_t points_drawn_ = 0;
};

}  // namespace

std::vector<Placement> place_near_walls(PlacementTask const& task) {
    return WallPlacement(task).run();
}

}  // namespace pogosim
