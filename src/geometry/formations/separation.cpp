#include "geometry/formations/separation.hpp"

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "geometry/formations/disk_field.hpp"

namespace pogosim {

namespace {

constexpr float kTargetMargin = 1.002F;      // aim a little beyond contact, so that pushing ends
constexpr int kRounds = 2;                   // of pushing, then moving what is caught
constexpr std::size_t kMostMoves = 2000000;  // of single objects in a round of pushing
constexpr std::size_t kFewestPasses = 50;
constexpr std::size_t kMostPasses = 2000;

class Separation {
public:
    Separation(PlacementTask const& task, std::vector<Vec2>& places, std::span<Vec2 const> spare_places)
        : task_(task), places_(places), spare_places_(spare_places), field_(task.domain.bounds, task.radii_mm) {}

    bool run() {
        for (int round = 0; round < kRounds; ++round) {
            if (push_apart() || move_caught_objects()) {
                return true;
            }
        }
        return false;
    }

private:
    bool push_apart() {
        std::size_t const passes = std::clamp(kMostMoves / places_.size(), kFewestPasses, kMostPasses);
        for (std::size_t pass = 0; pass < passes; ++pass) {
            push_off_walls();
            refill_field();
            if (!push_pairs()) {
                return all_clear_of_walls();
            }
        }
        return false;
    }

    void push_off_walls() {
        for (std::size_t i = 0; i < places_.size(); ++i) {
            places_[i] = task_.space.holds(places_[i], task_.radii_mm[i])
                             ? places_[i]
                             : task_.space.pushed_inside(places_[i], task_.radii_mm[i]);
        }
    }

    bool all_clear_of_walls() const {
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (!task_.space.holds(places_[i], task_.radii_mm[i])) {
                return false;
            }
        }
        return true;
    }

    void refill_field() {
        field_.clear();
        for (std::uint32_t i = 0; i < places_.size(); ++i) {
            field_.put(i, places_[i]);
        }
    }

    /// Moves the two of each overlapping pair apart. Returns whether there was one.
    bool push_pairs() {
        bool pushed = false;
        for (std::uint32_t i = 0; i < places_.size(); ++i) {
            field_.any_near(places_[i], task_.radii_mm[i],
                            [&](std::uint32_t j, Vec2 /*place at the start of the pass*/) {
                                pushed |= j > i && push_pair(i, j);
                                return false;
                            });
        }
        return pushed;
    }

    bool push_pair(std::uint32_t i, std::uint32_t j) {
        float const apart_mm = task_.radii_mm[i] + task_.radii_mm[j];
        Vec2 const between = places_[j] - places_[i];
        float const distance_mm = length(between);
        if (distance_mm >= apart_mm) {
            return false;
        }
        Vec2 const unit = distance_mm > 0.0F ? (1.0F / distance_mm) * between : random_direction();
        // The smaller moves more, as if by mass.
        float const mass_i = task_.radii_mm[i] * task_.radii_mm[i];
        float const mass_j = task_.radii_mm[j] * task_.radii_mm[j];
        float const share_i = mass_j / (mass_i + mass_j);
        Vec2 const push = (kTargetMargin * apart_mm - distance_mm) * unit;
        places_[i] = places_[i] - share_i * push;
        places_[j] = places_[j] + (1.0F - share_i) * push;
        return true;
    }

    Vec2 random_direction() { return direction(task_.random.uniform(0.0F, 2.0F * std::numbers::pi_v<float>)); }

    /// Keeps the objects that stand well, larger ones first, and moves the others to spare places. Returns whether all
    /// found one.
    bool move_caught_objects() {
        field_.clear();
        std::vector<std::uint32_t> caught;
        for (std::uint32_t const i : largest_first(task_.radii_mm)) {
            if (has_room(places_[i], task_.radii_mm[i])) {
                field_.put(i, places_[i]);
            } else {
                caught.push_back(i);
            }
        }
        return move_to_spare_places(caught);
    }

    /// `caught` is sorted by radius: for equals, a spare place refused to one is refused to the next.
    bool move_to_spare_places(std::vector<std::uint32_t> const& caught) {
        bool all_moved = true;
        float radius_mm = 0.0F;
        auto spare = spare_places_.begin();
        for (std::uint32_t const i : caught) {
            if (task_.radii_mm[i] != radius_mm) {
                radius_mm = task_.radii_mm[i];
                spare = spare_places_.begin();
            }
            spare = std::find_if(spare, spare_places_.end(), [&](Vec2 place) { return has_room(place, radius_mm); });
            if (spare == spare_places_.end()) {
                all_moved = false;
                continue;
            }
            places_[i] = *spare;
            field_.put(i, *spare);
        }
        return all_moved;
    }

    bool has_room(Vec2 place, float radius_mm) const {
        return task_.space.holds(place, radius_mm) && field_.is_free(place, radius_mm);
    }

    PlacementTask const& task_;
    std::vector<Vec2>& places_;
    std::span<Vec2 const> spare_places_;
    DiskField field_;
};

}  // namespace

bool separate(PlacementTask const& task, std::vector<Vec2>& places_mm, std::span<Vec2 const> spare_places_mm) {
    return Separation(task, places_mm, spare_places_mm).run();
}

}  // namespace pogosim
