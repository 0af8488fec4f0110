#include "physics/continuous_collision.hpp"

#include <algorithm>
#include <cmath>

namespace pogosim {

namespace {

constexpr float kRoundingMm = 1.0F;  // of positions far from the origin
// Disks may overlap by this much, and may then approach by kNearerMm in a step, so that disks that slide along each
// other are not stopped.
constexpr float kOverlapMm = 0.25F;
constexpr float kNearerMm = 0.01F;
// A body whose motion has been shortened this often stays at its start, as a fixed obstacle for the others.
constexpr int kMostCuts = 20;

/// The fraction of a relative motion after which two disks touch; 1 if they never do. `way_mm`: from one centre to the
/// other at the start. Disks that overlap touch when they come nearer.
float fraction_to_touch(Vec2 way_mm, Vec2 motion_mm, float radius_mm) {
    float const start_mm = length(way_mm);
    float const touch_mm = std::min(radius_mm - kOverlapMm, start_mm - kNearerMm);
    float const a = squared_length(motion_mm);
    float const b = dot(way_mm, motion_mm);
    float const c = start_mm * start_mm - touch_mm * touch_mm;
    float const discriminant = b * b - a * c;
    if (touch_mm <= 0.0F || b >= 0.0F || discriminant < 0.0F) {
        return 1.0F;
    }
    return std::min(c / (-b + std::sqrt(discriminant)), 1.0F);
}

}  // namespace

ContinuousCollision::ContinuousCollision(World const& world) : is_of_membrane_(world.bodies.size(), 0) {
    for (Membrane const& membrane : world.membranes) {
        std::fill_n(is_of_membrane_.begin() + membrane.body, membrane.body_count, 1);
    }
}

std::vector<std::uint32_t> const& ContinuousCollision::stop_at_impacts(World& world, Hulls const& hulls,
                                                                       Assemblies const& assemblies,
                                                                       std::span<std::uint32_t const> fast) {
    Bodies& bodies = world.bodies;
    find_ways(world, fast);
    stopped_.clear();
    waiting_.assign(fast.begin(), fast.end());
    is_waiting_.assign(bodies.size(), 0);
    cuts_.assign(bodies.size(), 0);
    for (std::uint32_t const i : fast) {
        is_waiting_[i] = 1;
    }
    // First in, first out. Fractions only decrease, so the loop ends.
    for (std::size_t next = 0; next < waiting_.size(); ++next) {
        std::uint32_t const i = waiting_[next];
        is_waiting_[i] = 0;
        float const fraction = free_fraction(world, hulls, assemblies, i);
        if (fraction < fractions_[i]) {
            fractions_[i] = ++cuts_[i] < kMostCuts ? fraction : 0.0F;
            bodies.position_mm[i] = starts_mm_[i] + fractions_[i] * motions_mm_[i];
            if (hulls.is_one(i)) {
                bodies.heading_rad[i] = wrap_angle(bodies.start_rad[i] + fractions_[i] * turns_rad_[i]);
                bodies.heading_dir[i] = direction(bodies.heading_rad[i]);
            }
            stopped_.push_back(i);
            look_at_again(world, i);
        }
    }
    return stopped_;
}

void ContinuousCollision::find_ways(World const& world, std::span<std::uint32_t const> fast) {
    Bodies const& bodies = world.bodies;
    starts_mm_.resize(bodies.size());
    motions_mm_.resize(bodies.size());
    turns_rad_.resize(bodies.size());
    fractions_.assign(bodies.size(), 1.0F);
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        starts_mm_[i] = bodies.start_mm[i];
        motions_mm_[i] = minimum_image(world, starts_mm_[i], bodies.position_mm[i]);
        turns_rad_[i] = wrap_angle(bodies.heading_rad[i] - bodies.start_rad[i]);
    }
    for (std::uint32_t const i : fast) {
        motions_mm_[i] = bodies.position_mm[i] - starts_mm_[i];  // not wrapped yet
    }
    float farthest2 = 0.0F;
    largest_mm_ = 0.0F;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        farthest2 = std::max(farthest2, squared_length(motions_mm_[i]));
        largest_mm_ = std::max(largest_mm_, bodies.radius_mm[i]);
    }
    farthest_mm_ = std::sqrt(farthest2);
    grid_.build(starts_mm_, world.arena.bounds, 2.0F * (farthest_mm_ + largest_mm_), world.periodic);
}

/// Largest distance between the starting points of a body and of another one that it can meet in the step.
float ContinuousCollision::reach_mm(Bodies const& bodies, std::uint32_t i) const {
    return length(motions_mm_[i]) + farthest_mm_ + bodies.radius_mm[i] + largest_mm_ + kRoundingMm;
}

bool ContinuousCollision::can_stop(Assemblies const& assemblies, std::uint32_t i, std::uint32_t k) const {
    return i != k && assemblies.may_collide(i, k) && (is_of_membrane_[i] == 0 || is_of_membrane_[k] == 0);
}

/// The fraction of its motion that a body can make before it meets another one.
float ContinuousCollision::free_fraction(World const& world, Hulls const& hulls, Assemblies const& assemblies,
                                         std::uint32_t i) const {
    Bodies const& bodies = world.bodies;
    float fraction = fractions_[i];
    grid_.for_each_near(starts_mm_[i], reach_mm(bodies, i), [&](std::uint32_t k, Vec2 /*start_mm*/) {
        if (!can_stop(assemblies, i, k)) {
            return;
        }
        if (hulls.is_one(i) || (hulls.is_one(k) && !bodies.spec[k].fixed)) {
            fraction = std::min(fraction, fraction_before_hull(world, hulls, i, k));
        } else if (hulls.is_one(k)) {
            for (std::uint32_t part = 0; part < hulls.part_count(k); ++part) {
                fraction = std::min(fraction, hulls.fraction_to_touch(world, k, part, starts_mm_[i], motions_mm_[i],
                                                                      bodies.radius_mm[i]));
            }
        } else {
            fraction = std::min(fraction, fraction_before(world, i, k));
        }
    });
    return fraction;
}

/// The fraction that body i can make before it meets body k. Both move until one of them stops; then the other one
/// continues alone.
float ContinuousCollision::fraction_before(World const& world, std::uint32_t i, std::uint32_t k) const {
    float const radius_mm = world.bodies.radius_mm[i] + world.bodies.radius_mm[k];
    Vec2 const way_mm = minimum_image(world, starts_mm_[i], starts_mm_[k]);
    Vec2 const together_mm = motions_mm_[k] - motions_mm_[i];
    float const together = std::min(fractions_[i], fractions_[k]);
    float const met = together * fraction_to_touch(way_mm, together * together_mm, radius_mm);
    if (met < together || fractions_[k] >= fractions_[i]) {
        return met < together ? met : fractions_[i];
    }
    float const alone = fractions_[i] - together;
    Vec2 const rest_mm = way_mm + together * together_mm;
    return together + alone * fraction_to_touch(rest_mm, -alone * motions_mm_[i], radius_mm);
}

/// A part of a body after a fraction of its motion, about a point near its start.
Hull ContinuousCollision::hull_at(World const& world, Hulls const& hulls, PartOf const& part, float fraction,
                                  Vec2 origin_mm) const {
    std::uint32_t const i = part.body;
    float const made = std::min(fraction, fractions_[i]);
    Vec2 const place_mm = minimum_image(world, origin_mm, starts_mm_[i]) + made * motions_mm_[i];
    return placed(hulls.of(world, i, part.part), place_mm, direction(world.bodies.start_rad[i] + made * turns_rad_[i]));
}

/// The same as fraction_before() if one of them is a hull.
float ContinuousCollision::fraction_before_hull(World const& world, Hulls const& hulls, std::uint32_t i,
                                                std::uint32_t k) const {
    Bodies const& bodies = world.bodies;
    float fraction = fractions_[i];
    float const between_disks_mm =
        length(minimum_image(world, starts_mm_[i], starts_mm_[k])) - bodies.radius_mm[i] - bodies.radius_mm[k];
    if (between_disks_mm >= length(motions_mm_[i]) + length(motions_mm_[k])) {
        return fraction;
    }
    for (std::uint32_t own = 0; own < hulls.part_count(i); ++own) {
        for (std::uint32_t other = 0; other < hulls.part_count(k); ++other) {
            fraction = std::min(fraction, fraction_before_part(world, hulls, {i, own}, {k, other}));
        }
    }
    return fraction;
}

/// Conservative advancement, in steps in which the gap cannot close: B. Mirtich, "Impulse-based dynamic simulation of
/// rigid body systems", PhD thesis, Berkeley 1996.
float ContinuousCollision::fraction_before_part(World const& world, Hulls const& hulls, PartOf const& own,
                                                PartOf const& other) const {
    constexpr int most_steps = 64;
    Bodies const& bodies = world.bodies;
    std::uint32_t const i = own.body;
    std::uint32_t const k = other.body;
    auto const gap_mm = [&](float fraction) {
        return gap_between_mm(hull_at(world, hulls, own, fraction, starts_mm_[i]),
                              hull_at(world, hulls, other, fraction, starts_mm_[i]));
    };
    float const closing_mm = length(motions_mm_[i]) + length(motions_mm_[k]) +
                             std::abs(turns_rad_[i]) * bodies.radius_mm[i] +
                             std::abs(turns_rad_[k]) * bodies.radius_mm[k];
    auto const start_of = [&](PartOf const& part) {
        auto const [centre_mm, radius_mm] = hulls.around(world, part.body, part.part);
        Vec2 const place_mm = minimum_image(world, starts_mm_[i], starts_mm_[part.body]);
        return Hulls::Around{place_mm + rotate(centre_mm, direction(bodies.start_rad[part.body])), radius_mm};
    };
    Hulls::Around const start = start_of(own);
    Hulls::Around const other_start = start_of(other);
    float const between_disks_mm =
        length(other_start.centre_mm - start.centre_mm) - start.radius_mm - other_start.radius_mm;
    if (between_disks_mm >= closing_mm) {
        return fractions_[i];
    }
    float free_mm = gap_mm(0.0F);
    float const touch_mm = std::min(-kOverlapMm, free_mm - kNearerMm);
    float fraction = 0.0F;
    for (int step = 0; step < most_steps; ++step) {
        fraction += (free_mm - touch_mm) / closing_mm;
        if (!(fraction < fractions_[i])) {
            return fractions_[i];
        }
        free_mm = gap_mm(fraction);
        if (free_mm - touch_mm < kNearerMm) {
            break;
        }
    }
    return fraction;
}

/// Queues all bodies that may meet body i where it has been stopped.
void ContinuousCollision::look_at_again(World const& world, std::uint32_t i) {
    grid_.for_each_near(starts_mm_[i], reach_mm(world.bodies, i), [&](std::uint32_t k, Vec2 /*start_mm*/) {
        if (k != i && is_waiting_[k] == 0 && fractions_[k] > fractions_[i] && !world.bodies.spec[k].fixed) {
            is_waiting_[k] = 1;
            waiting_.push_back(k);
        }
    });
}

}  // namespace pogosim
