#include "comms/visibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/memory.hpp"
#include "geometry/polygon.hpp"

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
float diamond_angle(Vec2 direction) {
    float const side = direction.y / (std::abs(direction.x) + std::abs(direction.y));
    if (direction.x >= 0.0F) {
        return side;
    }
    return direction.y >= 0.0F ? 2.0F - side : -2.0F - side;
}

/// Index of the robot's outline. They are in the order of the robots.
std::uint32_t outline_of(World const& world, std::uint32_t robot) {
    auto const found = std::ranges::lower_bound(world.outlines, robot, {}, &Outline::robot);
    return static_cast<std::uint32_t>(found - world.outlines.begin());
}

}  // namespace

float emitter_radius_mm(World const& world, std::uint32_t robot) {
    return world.spec_of(robot).emitters == Emitters::rim ? world.bodies.radius_mm[world.robots.body[robot]] : 0.0F;
}

void Visibility::update(World const& world) {
    Bodies const& bodies = world.bodies;
    positions_.clear();
    robots_.clear();
    largest_radius_mm_ = 0.0F;
    float longest_range_mm = 0.0F;
    for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
        RobotSpec const& spec = world.spec_of(i);
        longest_range_mm = std::max(longest_range_mm, spec.ir.longest_range_mm());
        if (spec.emitters != Emitters::outline) {
            std::uint32_t const body = world.robots.body[i];
            robots_.push_back(i);
            positions_.push_back(bodies.position_mm[body]);
            largest_radius_mm_ = std::max(largest_radius_mm_, bodies.radius_mm[body]);
        }
    }
    float const reach_mm = longest_range_mm + 2.0F * largest_radius_mm_;
    allocate_for([&] { return fmt::format("the neighbour grid of {} robots", positions_.size()); }, std::nullopt,
                 [&] { grid_.build(positions_, world.arena.bounds, std::max(reach_mm, 1.0F), world.periodic); });
    allocate_for([&] { return fmt::format("the outlines of {} walls and membranes", world.outlines.size()); },
                 std::nullopt, [&] { outlines_.update(world); });
}

void Visibility::gather_candidates(World const& world, std::uint32_t robot, float range_mm) {
    std::uint32_t const body = world.robots.body[robot];
    Vec2 const centre = world.bodies.position_mm[body];
    Vec2 const axis = world.bodies.heading_dir[body];
    float const reach_mm = emitter_radius_mm(world, robot) + range_mm;
    candidates_.clear();
    float const farthest_mm = reach_mm + largest_radius_mm_;
    grid_.for_each_near(centre, farthest_mm, [&](std::uint32_t k, Vec2 position) {
        Vec2 const offset = minimum_image(world, centre, position);
        float const distance_mm2 = squared_length(offset);
        std::uint32_t const other = robots_[k];
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
                                   .from_emitter_mm = {},
                                   .emitters = 0});
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

void Visibility::look(World const& world, std::uint32_t robot, int emitter, float range_mm) {
    float const rim_mm = emitter_radius_mm(world, robot);
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
            sight.low = diamond_angle(in_frame_of(sight.from_emitter_mm, half_width));
            sight.high = diamond_angle(rotate(sight.from_emitter_mm, half_width));
            if (is_covered(sight)) {
                return true;
            }
            cover(sight);
            return false;
        });
    }

    for (Sight const& sight : sights_) {
        Candidate& candidate = candidates_[sight.candidate];
        candidate.emitters |= 1U << static_cast<unsigned>(emitter);
        if (sight.distance_mm2 < candidate.nearest_mm2) {
            candidate.nearest_mm2 = sight.distance_mm2;
            candidate.from_emitter_mm = rotate(sight.from_emitter_mm, normal);
        }
    }
}

void Visibility::add_outlines_near(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm) {
    std::uint32_t const body = world.robots.body[robot];
    float const rim_mm = emitter_radius_mm(world, robot);
    outline_emitters_.assign(world.outlines.size(), 0);
    auto const pieces = outlines_.near(world, world.bodies.position_mm[body], rim_mm + range_mm);
    for (unsigned emitter = 0; emitter < kFaceCount; ++emitter) {
        unsigned const bit = 1U << emitter;
        if ((emitters & bit) == 0) {
            continue;
        }
        Vec2 const place = rotate(rim_mm * kFaceNormals[emitter], world.bodies.heading_dir[body]);
        for (OutlineIndex::Piece const& piece : pieces) {
            std::uint8_t& reached = outline_emitters_[piece.outline];
            if ((reached & bit) == 0 && squared_distance(piece, place) <= range_mm * range_mm) {
                reached = static_cast<std::uint8_t>(reached | bit);
            }
        }
    }
    for (std::uint32_t i = 0; i < outline_emitters_.size(); ++i) {
        if (outline_emitters_[i] != 0) {
            receivers_.push_back({.robot = world.outlines[i].robot,
                                  .from_emitter_mm = {},
                                  .faces = 1,
                                  .emitters = outline_emitters_[i]});
        }
    }
}

std::optional<Vec2> Visibility::to_outline(World const& world, std::uint32_t robot, std::uint32_t outline_robot,
                                           float radius_mm) {
    std::uint32_t const outline = outline_of(world, outline_robot);
    std::optional<Vec2> nearest;
    for (OutlineIndex::Piece const& piece :
         outlines_.near(world, world.bodies.position_mm[world.robots.body[robot]], radius_mm)) {
        Vec2 const point = nearest_on_segment(piece.from, piece.to, {});
        bool const is_nearest = piece.outline == outline && squared_length(point) <= radius_mm * radius_mm &&
                                (!nearest || squared_length(point) < squared_length(*nearest));
        if (is_nearest) {
            nearest = point;
        }
    }
    return nearest;
}

std::uint8_t Visibility::faces_near(World const& world, std::uint32_t robot, std::uint32_t outline, float range_mm) {
    std::uint32_t const body = world.robots.body[robot];
    float const rim_mm = emitter_radius_mm(world, robot);
    unsigned faces = 0;
    for (OutlineIndex::Piece const& piece : outlines_.near(world, world.bodies.position_mm[body], rim_mm + range_mm)) {
        for (unsigned face = 0; piece.outline == outline && face < kFaceCount; ++face) {
            Vec2 const place = rotate(rim_mm * kFaceNormals[face], world.bodies.heading_dir[body]);
            if (squared_distance(piece, place) <= range_mm * range_mm) {
                faces |= 1U << face;
            }
        }
    }
    return static_cast<std::uint8_t>(faces);
}

void Visibility::add_robots_near(World const& world, std::uint32_t outline, float range_mm) {
    Box const& box = outlines_.box(outline);
    Vec2 const middle = box.centre();
    Vec2 const half = 0.5F * box.size();
    for (std::size_t k = 0; k < robots_.size(); ++k) {
        // A robot hears an outline no further than it reaches it itself.
        float const reach_mm = std::min(range_mm, world.spec_of(robots_[k]).ir.range_mm);
        float const margin_mm = reach_mm + largest_radius_mm_;
        Vec2 const offset = minimum_image(world, middle, positions_[k]);
        if (std::abs(offset.x) > half.x + margin_mm || std::abs(offset.y) > half.y + margin_mm) {
            continue;
        }
        if (std::uint8_t const faces = faces_near(world, robots_[k], outline, reach_mm); faces != 0) {
            receivers_.push_back({.robot = robots_[k], .from_emitter_mm = {}, .faces = faces, .emitters = 1});
        }
    }
}

std::span<Receiver const> Visibility::receivers(World const& world, std::uint32_t robot, std::uint8_t emitters,
                                                float range_mm) {
    receivers_.clear();
    if (range_mm > 0.0F) {
        find_receivers(world, robot, emitters, range_mm);
    }
    if (!world.switched_off.empty()) {
        std::erase_if(receivers_, [&](Receiver const& receiver) { return !is_alive(world, receiver.robot); });
    }
    return receivers_;
}

void Visibility::find_receivers(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm) {
    if (world.spec_of(robot).emitters == Emitters::outline) {
        if ((emitters & 1U) != 0) {
            add_robots_near(world, outline_of(world, robot), range_mm);
        }
        return;
    }
    gather_candidates(world, robot, range_mm);
    for (int emitter = 0; emitter < kFaceCount; ++emitter) {
        if ((emitters >> emitter & 1) != 0) {
            look(world, robot, emitter, range_mm);
        }
    }
    Vec2 const axis = world.bodies.heading_dir[world.robots.body[robot]];
    for (Candidate const& candidate : candidates_) {
        if (std::isfinite(candidate.nearest_mm2)) {
            receivers_.push_back({.robot = candidate.robot,
                                  .from_emitter_mm = rotate(candidate.from_emitter_mm, axis),
                                  .faces = 0,
                                  .emitters = static_cast<std::uint8_t>(candidate.emitters)});
        }
    }
    if (!outlines_.empty()) {
        add_outlines_near(world, robot, emitters, range_mm);
    }
    std::sort(receivers_.begin(), receivers_.end(), [](auto const& a, auto const& b) { return a.robot < b.robot; });
}

std::uint8_t faces_that_see(World const& world, std::uint32_t receiver, Vec2 emitter_mm, float range_mm) {
    std::uint32_t const body = world.robots.body[receiver];
    float const rim_mm = emitter_radius_mm(world, receiver);
    Vec2 const emitter = in_frame_of(emitter_mm, world.bodies.heading_dir[body]);
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
