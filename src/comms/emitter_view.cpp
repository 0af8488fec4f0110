#include "comms/emitter_view.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

namespace pogosim {

namespace {

/// `v` in the frame of face d: x along its outward normal. Face 0 looks along x, face 1 along y, and so on.
constexpr Vec2 in_frame_of_face(Vec2 v, unsigned face) {
    switch (face) {
        case 0:
            return v;
        case 1:
            return {v.y, -v.x};
        case 2:
            return {-v.x, -v.y};
        default:
            return {-v.y, v.x};
    }
}

/// The same back.
constexpr Vec2 from_frame_of_face(Vec2 v, unsigned face) {
    return in_frame_of_face(v, (kFaceCount - face) % kFaceCount);
}

/// `v` in the frame whose x axis is the unit vector `axis`.
constexpr Vec2 in_frame_of(Vec2 v, Vec2 axis) {
    return {dot(axis, v), cross(axis, v)};
}

/// Grows with the angle of the direction from -180 to 180 degrees as -2 to 2, without trigonometry.
float diamond_angle(Vec2 direction) {
    float const side = direction.y / (std::abs(direction.x) + std::abs(direction.y));
    if (direction.x >= 0.0F) {
        return side;
    }
    return direction.y >= 0.0F ? 2.0F - side : -2.0F - side;
}

/// The candidate's centre as an emitter sees it: x along the outward normal.
Vec2 seen_from(EmitterView::Candidate const& candidate, unsigned emitter, float rim_mm) {
    return in_frame_of_face(candidate.offset_mm, emitter) - Vec2{rim_mm, 0.0F};
}

}  // namespace

std::span<EmitterView::Candidate const> EmitterView::look(unsigned emitters, float rim_mm, float range_mm,
                                                          bool ignore_occlusions) {
    std::span<Candidate> const candidates = std::span(candidates_).first(count_);
    unsigned in_view = 0;
    for (Candidate& candidate : candidates) {
        float const reach_mm = range_mm + candidate.radius_mm;
        unsigned seen_by = 0;
        for (unsigned emitter = 0; emitter < kFaceCount; ++emitter) {
            Vec2 const seen = seen_from(candidate, emitter, rim_mm);
            bool const in_front = static_cast<int>(seen.x >= 0.0F) | static_cast<int>(ignore_occlusions);
            bool const in_reach = squared_length(seen) <= reach_mm * reach_mm;
            seen_by |= static_cast<unsigned>(in_front & in_reach) << emitter;
        }
        candidate.emitters = seen_by & emitters;
        in_view |= candidate.emitters;
    }
    for (unsigned emitter = 0; emitter < kFaceCount && !ignore_occlusions; ++emitter) {
        if ((in_view >> emitter & 1U) != 0) {
            look_ahead(emitter, rim_mm);
        }
    }
    return candidates;
}

void EmitterView::look_ahead(unsigned emitter, float rim_mm) {
    sights_.clear();
    for (std::uint32_t c = 0; c < count_; ++c) {
        if ((candidates_[c].emitters >> emitter & 1U) == 0) {
            continue;
        }
        Vec2 const seen = seen_from(candidates_[c], emitter, rim_mm);
        Sight const sight{.distance_mm2 = squared_length(seen), .candidate = c, .seen_mm = seen};
        // Behind those that are as near: few of them, so inserting is fastest.
        auto place = sights_.end();
        while (place != sights_.begin() && sight.distance_mm2 < std::prev(place)->distance_mm2) {
            --place;
        }
        sights_.insert(place, sight);
    }
    if (!may_hide_each_other()) {
        return;
    }
    // From near to far: what is not wholly in the shadow of visible robots is visible and casts a shadow.
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

bool EmitterView::may_hide_each_other() const {
    // Nobody is covered whose centre lies outside of the shadow of each nearer one, by more than rounding does. That of
    // a disk of radius r at distance d spans the directions at angles a from its centre with sin a <= r / d. Shadows
    // of nearly 180 degrees are left to the full calculation.
    for (std::size_t i = 0; i < sights_.size(); ++i) {
        Sight const& sight = sights_[i];
        float const radius_mm = candidates_[sight.candidate].radius_mm;
        float const radius2_mm2 = radius_mm * radius_mm;
        if (sights_.size() > 1 && radius2_mm2 > 0.9F * sight.distance_mm2) {
            return true;
        }
        float const reach_mm2 = 1.01F * radius2_mm2 + 1e-4F * sight.distance_mm2;
        for (std::size_t k = i + 1; k < sights_.size(); ++k) {
            float const across = cross(sight.seen_mm, sights_[k].seen_mm);
            if (across * across <= reach_mm2 * sights_[k].distance_mm2) {
                return true;
            }
        }
    }
    return false;
}

bool EmitterView::is_covered(Interval const& sight) const {
    return std::any_of(shadows_.begin(), shadows_.end(),
                       [&](Interval const& s) { return s.low <= sight.low && sight.high <= s.high; });
}

void EmitterView::cover(Interval const& sight) {
    // Joins the new shadow with all those it touches; the rest stays.
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

Vec2 from_nearest_emitter_mm(EmitterView::Candidate const& candidate, float rim_mm) {
    float nearest_mm2 = std::numeric_limits<float>::infinity();
    Vec2 nearest;
    for (unsigned emitters = candidate.emitters; emitters != 0; emitters &= emitters - 1) {
        auto const emitter = static_cast<unsigned>(std::countr_zero(emitters));
        Vec2 const seen = seen_from(candidate, emitter, rim_mm);
        float const distance_mm2 = squared_length(seen);
        if (distance_mm2 < nearest_mm2) {
            nearest_mm2 = distance_mm2;
            nearest = from_frame_of_face(seen, emitter);
        }
    }
    return nearest;
}

std::uint8_t faces_that_see(Vec2 emitter_mm, float rim_mm, float range_mm) {
    unsigned faces = 0;
    unsigned best = 0;
    float most_ahead = emitter_mm.x;
    for (unsigned face = 0; face < kFaceCount; ++face) {
        Vec2 const seen = in_frame_of_face(emitter_mm, face);
        if (seen.x > most_ahead) {
            most_ahead = seen.x;
            best = face;
        }
        Vec2 const from_face = seen - Vec2{rim_mm, 0.0F};
        if (seen.x >= rim_mm && squared_length(from_face) <= range_mm * range_mm) {
            faces |= 1U << face;
        }
    }
    return static_cast<std::uint8_t>(faces != 0 ? faces : 1U << best);
}

}  // namespace pogosim
