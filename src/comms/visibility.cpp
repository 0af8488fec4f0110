#include "comms/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pogosim {

namespace {

/// Unit vectors of the faces' outward normals in the robot's frame: front, right, back, left (y to the right).
constexpr std::array<Vec2, kFaceCount> kFaceNormals{Vec2{1.0F, 0.0F}, Vec2{0.0F, 1.0F}, Vec2{-1.0F, 0.0F},
                                                    Vec2{0.0F, -1.0F}};

/// `v` in the frame whose x axis is the unit vector `axis`.
constexpr Vec2 in_frame_of(Vec2 v, Vec2 axis) {
    return {dot(axis, v), cross(axis, v)};
}

/// Grows with the angle of the direction from -180 to 180 degrees as -2 to 2, without trigonometry.
float pseudo_angle(Vec2 direction) {
    float const side = direction.y / (std::abs(direction.x) + std::abs(direction.y));
    if (direction.x >= 0.0F) {
        return side;
    }
    return direction.y >= 0.0F ? 2.0F - side : -2.0F - side;
}

}  // namespace

void Visibility::update(World const& world) {
    Bodies const& bodies = world.bodies;
    positions_.resize(world.robots.size());
    largest_radius_mm_ = 0.0F;
    float longest_range_mm = 0.0F;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        std::uint32_t const body = world.robots.body[i];
        positions_[i] = bodies.position_mm[body];
        largest_radius_mm_ = std::max(largest_radius_mm_, bodies.radius_mm[body]);
    }
    for (Category const& category : world.categories) {
        longest_range_mm = std::max(longest_range_mm, category.spec.ir.range_mm);
    }
    float const reach_mm = longest_range_mm + 2.0F * largest_radius_mm_;
    grid_.build(positions_, world.arena.bounds, std::max(reach_mm, 1.0F), world.periodic);
}

void Visibility::gather_candidates(World const& world, std::uint32_t robot) {
    std::uint32_t const body = world.robots.body[robot];
    Vec2 const centre = world.bodies.position_mm[body];
    Vec2 const axis = world.bodies.axis[body];
    float const reach_mm = world.bodies.radius_mm[body] + world.spec_of(robot).ir.range_mm;
    candidates_.clear();
    float const farthest_mm = reach_mm + largest_radius_mm_;
    grid_.for_each_near(centre, farthest_mm, [&](std::uint32_t other, Vec2 position) {
        Vec2 const offset = shortest_vector(world, centre, position);
        float const distance_mm2 = squared_length(offset);
        if (distance_mm2 > farthest_mm * farthest_mm || other == robot) {
            return;
        }
        float const radius_mm = world.bodies.radius_mm[world.robots.body[other]];
        float const limit_mm = reach_mm + radius_mm;
        if (distance_mm2 <= limit_mm * limit_mm) {
            candidates_.push_back({.robot = other,
                                   .offset_mm = in_frame_of(offset, axis),
                                   .radius_mm = radius_mm,
                                   .nearest_mm2 = std::numeric_limits<float>::infinity(),
                                   .from_emitter_mm = {}});
        }
    });
}

bool Visibility::is_covered(Sight const& sight) const {
    return std::any_of(shadows_.begin(), shadows_.end(),
                       [&](Interval const& s) { return s.low <= sight.low && sight.high <= s.high; });
}

void Visibility::cover(Sight const& sight) {
    // Joins the new shadow with all those it touches; the rest stays.
    Interval joined{sight.low, sight.high};
    std::erase_if(shadows_, [&](Interval const& s) {
        bool const touches = s.low <= joined.high && joined.low <= s.high;
        if (touches) {
            joined = {std::min(joined.low, s.low), std::max(joined.high, s.high)};
        }
        return touches;
    });
    shadows_.push_back(joined);
}

void Visibility::look(World const& world, std::uint32_t robot, int emitter) {
    float const rim_mm = world.bodies.radius_mm[world.robots.body[robot]];
    float const range_mm = world.spec_of(robot).ir.range_mm;
    Vec2 const normal = kFaceNormals[static_cast<std::size_t>(emitter)];

    // Everything in range, in front of the emitter unless occlusions are ignored.
    sights_.clear();
    for (std::uint32_t c = 0; c < candidates_.size(); ++c) {
        Candidate const& candidate = candidates_[c];
        Vec2 const seen = in_frame_of(candidate.offset_mm, normal) - Vec2{rim_mm, 0.0F};
        float const distance_mm2 = squared_length(seen);
        float const reach_mm = range_mm + candidate.radius_mm;
        bool const in_front = seen.x >= 0.0F || world.ignore_occlusions;
        if (in_front && distance_mm2 <= reach_mm * reach_mm) {
            sights_.push_back(
                {.distance_mm2 = distance_mm2, .low = 0, .high = 0, .candidate = c, .from_emitter_mm = seen});
        }
    }

    // From near to far: what is not wholly in the shadow of visible robots is visible and casts a shadow.
    if (!world.ignore_occlusions && sights_.size() > 1) {
        std::sort(sights_.begin(), sights_.end(), [](Sight const& a, Sight const& b) {
            return a.distance_mm2 != b.distance_mm2 ? a.distance_mm2 < b.distance_mm2 : a.candidate < b.candidate;
        });
        shadows_.clear();
        std::erase_if(sights_, [&](Sight& sight) {
            float const radius_mm = candidates_[sight.candidate].radius_mm;
            float const sine2 = std::min(radius_mm * radius_mm / sight.distance_mm2, 1.0F);
            Vec2 const half_width{std::sqrt(1.0F - sine2), std::sqrt(sine2)};
            sight.low = pseudo_angle(in_frame_of(sight.from_emitter_mm, half_width));
            sight.high = pseudo_angle(rotate(sight.from_emitter_mm, half_width));
            if (is_covered(sight)) {
                return true;
            }
            cover(sight);
            return false;
        });
    }

    for (Sight const& sight : sights_) {
        Candidate& candidate = candidates_[sight.candidate];
        if (sight.distance_mm2 < candidate.nearest_mm2) {
            candidate.nearest_mm2 = sight.distance_mm2;
            candidate.from_emitter_mm = rotate(sight.from_emitter_mm, normal);
        }
    }
}

std::span<Receiver const> Visibility::receivers(World const& world, std::uint32_t robot, std::uint8_t emitters) {
    receivers_.clear();
    if (world.spec_of(robot).ir.range_mm <= 0.0F) {
        return receivers_;
    }
    gather_candidates(world, robot);
    for (int emitter = 0; emitter < kFaceCount; ++emitter) {
        if ((emitters >> emitter & 1) != 0) {
            look(world, robot, emitter);
        }
    }
    Vec2 const axis = world.bodies.axis[world.robots.body[robot]];
    for (Candidate const& candidate : candidates_) {
        if (std::isfinite(candidate.nearest_mm2)) {
            receivers_.push_back({candidate.robot, rotate(candidate.from_emitter_mm, axis)});
        }
    }
    std::sort(receivers_.begin(), receivers_.end(), [](auto const& a, auto const& b) { return a.robot < b.robot; });
    return receivers_;
}

std::uint8_t faces_that_see(World const& world, std::uint32_t receiver, Vec2 emitter_mm, float range_mm) {
    std::uint32_t const body = world.robots.body[receiver];
    float const rim_mm = world.bodies.radius_mm[body];
    Vec2 const emitter = in_frame_of(emitter_mm, world.bodies.axis[body]);
    std::uint8_t faces = 0;
    std::size_t best = 0;
    for (std::size_t face = 0; face < kFaceCount; ++face) {
        float const ahead = dot(kFaceNormals[face], emitter);
        if (ahead > dot(kFaceNormals[best], emitter)) {
            best = face;
        }
        Vec2 const from_face = emitter - rim_mm * kFaceNormals[face];
        if (ahead >= rim_mm && squared_length(from_face) <= range_mm * range_mm) {
            faces = static_cast<std::uint8_t>(faces | 1U << face);
        }
    }
    return faces != 0 ? faces : static_cast<std::uint8_t>(1U << best);
}

}  // namespace pogosim
