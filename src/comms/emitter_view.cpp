#include "comms/emitter_view.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

namespace pogosim {

namespace {

/// `v` in the frame whose x axis is the unit vector `axis`.
constexpr Vec2 in_frame_of(Vec2 v, Vec2 axis) {
    return {dot(axis, v), cross(axis, v)};
}

/// Monotonic in the angle of the direction: -2 to 2 for -180 to 180 degrees, without trigonometry.
float diamond_angle(Vec2 direction) {
    float const side = direction.y / (std::abs(direction.x) + std::abs(direction.y));
    if (direction.x >= 0.0F) {
        return side;
    }
    return direction.y >= 0.0F ? 2.0F - side : -2.0F - side;
}

}  // namespace

std::span<EmitterView::Candidate const> EmitterView::look(unsigned emitters, Faces const& faces, float range_mm,
                                                          bool ignore_occlusions) {
    std::span<Candidate> const candidates = std::span(candidates_).first(count_);
    FourInts const also_behind = ignore_occlusions ? ~FourInts{} : FourInts{};
    views_.clear();
    for (Candidate& candidate : candidates) {
        FaceView const seen = seen_from(faces, candidate.offset_mm);
        Four const distance_mm2 = seen.distance_mm2;
        float const limit_mm = range_mm + candidate.radius_mm;
        FourInts const is_in_view =
            (is_in_cone(seen, faces.emission_cosine2) | also_behind) & (distance_mm2 <= all_four(limit_mm * limit_mm));
        candidate.emitters = bits_of(is_in_view) & emitters;
        // A disk of radius r at distance d hides the directions at angles a from its centre with sin a <= r / d, up to
        // rounding errors. Shadows of nearly 180 degrees are left to the full calculation.
        Four const radius_mm2 = all_four(candidate.radius_mm * candidate.radius_mm);
        Four const shadow_mm2 = radius_mm2 > 0.9F * distance_mm2 ? all_four(std::numeric_limits<float>::max())
                                                                 : 1.01F * radius_mm2 + 1e-4F * distance_mm2;
        views_.push_back({is_in_view, seen.x, seen.y, distance_mm2, shadow_mm2});
    }
    if (!ignore_occlusions) {
        for (unsigned left = emitters_with_shadows() & emitters; left != 0; left &= left - 1) {
            look_ahead(static_cast<unsigned>(std::countr_zero(left)));
        }
    }
    return candidates;
}

/// Emitters for which one robot may hide another: a robot is not hidden if its centre lies outside the shadows of all
/// others.
unsigned EmitterView::emitters_with_shadows() const {
    FourInts has_shadows{};
    for (std::size_t i = 1; i < views_.size() && bits_of(has_shadows) != (1U << kLanes) - 1U; ++i) {
        Views const& view = views_[i];
        for (Views const& other : std::span(views_).first(i)) {
            Four const across = view.x * other.y - view.y * other.x;
            Four const across2 = across * across;
            has_shadows |=
                view.is_in_view & other.is_in_view &
                ((across2 <= view.shadow_mm2 * other.distance_mm2) | (across2 <= other.shadow_mm2 * view.distance_mm2));
        }
    }
    return bits_of(has_shadows);
}

void EmitterView::look_ahead(unsigned emitter) {
    sights_.clear();
    for (std::uint32_t c = 0; c < count_; ++c) {
        if ((candidates_[c].emitters >> emitter & 1U) == 0) {
            continue;
        }
        Views const& view = views_[c];
        Vec2 const seen{view.x[emitter], view.y[emitter]};
        Sight const sight{.distance_mm2 = view.distance_mm2[emitter], .candidate = c, .seen_mm = seen};
        // Insertion sort, which is fastest for so few. Equal distances keep their order.
        auto place = sights_.end();
        while (place != sights_.begin() && sight.distance_mm2 < std::prev(place)->distance_mm2) {
            --place;
        }
        sights_.insert(place, sight);
    }
    // From near to far: a robot that is not completely in the shadow of visible robots is visible and casts a shadow.
    shadows_.clear();
    for (Sight const& sight : sights_) {
        float const radius_mm = candidates_[sight.candidate].radius_mm;
        float const sine2 = std::min(radius_mm * radius_mm / sight.distance_mm2, 1.0F);
        Vec2 const half_width{std::sqrt(1.0F - sine2), std::sqrt(sine2)};
        Interval const shadow{.low = diamond_angle(in_frame_of(sight.seen_mm, half_width)),
                              .high = diamond_angle(rotate(sight.seen_mm, half_width))};
        if (is_covered(shadow)) {
            candidates_[sight.candidate].emitters &= ~(1U << emitter);
        } else {
            cover(shadow);
        }
    }
}

bool EmitterView::is_covered(Interval const& sight) const {
    return std::any_of(shadows_.begin(), shadows_.end(),
                       [&](Interval const& s) { return s.low <= sight.low && sight.high <= s.high; });
}

void EmitterView::cover(Interval const& sight) {
    // Merges the new shadow with all shadows that it touches.
    Interval joined = sight;
    std::erase_if(shadows_, [&](Interval const& s) {
        bool const touches = s.low <= joined.high && joined.low <= s.high;
        if (touches) {
            joined = {std::min(joined.low, s.low), std::max(joined.high, s.high)};
        }
        return touches;
    });
    shadows_.push_back(joined);
}

Vec2 from_nearest_emitter_mm(EmitterView::Candidate const& candidate, Faces const& faces) {
    FourInts const sees = mask_of(candidate.emitters);
    Four const distance_mm2 =
        sees ? seen_from(faces, candidate.offset_mm).distance_mm2 : all_four(std::numeric_limits<float>::infinity());
    auto const nearest = static_cast<unsigned>(std::countr_zero(bits_of(distance_mm2 == smallest(distance_mm2))));
    return candidate.offset_mm - faces.place_mm[nearest];
}

}  // namespace pogosim
