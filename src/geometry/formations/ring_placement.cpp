#include "geometry/formations/ring_placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "base/exact_math.hpp"
#include "geometry/formations/disk_field.hpp"

namespace pogosim {

namespace {

// Looked at in all, so that a hopeless request ends soon: so many, or so many for each object.
constexpr std::int64_t kMostNodes = 10'000'000;
constexpr std::int64_t kMostNodesPerObject = 20;

/// Distance from the centre to the farthest corner of the bounding box.
float farthest_corner_mm(Box box, Vec2 centre) {
    return exact::hypot(std::max(centre.x - box.min.x, box.max.x - centre.x),
                        std::max(centre.y - box.min.y, box.max.y - centre.y));
}

class RingPlacement {
public:
    RingPlacement(PlacementTask const& task, Vec2 centre, std::function<RingPattern(float)> const& pattern_for,
                  std::string_view remedy)
        : task_(task),
          pattern_for_(pattern_for),
          remedy_(remedy),
          extent_mm_(farthest_corner_mm(task.domain.bounds, centre)),
          field_(task.domain.bounds, task.radii_mm),
          placements_(task.radii_mm.size()),
          most_nodes_(std::max(kMostNodes, kMostNodesPerObject * std::ssize(task.radii_mm))) {}

    std::vector<Placement> run() {
        std::vector<std::uint32_t> const order = largest_first(task_.radii_mm);
        for (auto next = order.begin(); next != order.end();) {
            float const radius_mm = task_.radii_mm[*next];
            auto const end = std::find_if(next, order.end(), [&](auto i) { return task_.radii_mm[i] != radius_mm; });
            place_equals(std::span(next, end), radius_mm);
            next = end;
        }
        return std::move(placements_);
    }

private:
    void place_equals(std::span<std::uint32_t const> objects, float radius_mm) {
        RingPattern const pattern = pattern_for_(radius_mm);
        auto object = objects.begin();
        for (int ring = 0; static_cast<float>(ring) * pattern.step_mm <= extent_mm_; ++ring) {
            for (Vec2 const node : pattern.nodes(ring)) {
                if (++nodes_seen_ > most_nodes_) {
                    refuse();
                }
                if (task_.space.holds(node, radius_mm) && field_.is_free(node, radius_mm)) {
                    field_.put(*object, node);
                    placements_[*object] = {node, kHeadingToDraw};
                    ++placed_;
                    if (++object == objects.end()) {
                        return;
                    }
                }
            }
        }
        refuse();
    }

    [[noreturn]] void refuse() const {
        throw FormationError(kFormationKey,
                             fmt::format("'{}' has room for only {} of {} in this {}; {}", task_.spec.name, placed_,
                                         describe_objects(task_), task_.ground, remedy_));
    }

    PlacementTask const& task_;
    std::function<RingPattern(float)> const& pattern_for_;
    std::string_view remedy_;
    float extent_mm_;
    DiskField field_;
    std::vector<Placement> placements_;
    std::size_t placed_ = 0;
    std::int64_t most_nodes_;
    std::int64_t nodes_seen_ = 0;
};

}  // namespace

std::vector<Placement> place_on_rings(PlacementTask const& task, Vec2 centre,
                                      std::function<RingPattern(float radius_mm)> const& pattern_for,
                                      std::string_view remedy) {
    return RingPlacement(task, centre, pattern_for, remedy).run();
}

}  // namespace pogosim
