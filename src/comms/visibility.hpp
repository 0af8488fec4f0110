// Who sees whom over infrared.
//
//                front (0)
//               .---^---.
//              |         |
//    left (3) <           > right (1)
//              |         |
//               '---v---'
//                back (2)
//
// An emitter sits on the rim at 0, 90, 180 and 270 degrees and radiates over the half plane in front of it. It reaches
// another robot when that robot's border is within range of the emitter, its centre lies in the half plane, and nearer
// robots that the emitter sees leave at least a part of it uncovered.
//
// Walls and membranes send and receive along their whole outline instead: there are no half planes and no shadows
// between an outline and a robot, only the distance from the outline to the robot's emitters.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/grid.hpp"
#include "comms/outline_index.hpp"
#include "world/world.hpp"

namespace pogosim {

/// One robot that a transmission reaches.
struct Receiver {
    std::uint32_t robot = 0;
    Vec2 from_emitter_mm;  // from the emitter (the nearest one that sees it) to the receiver's centre
    // Bit d: its face d receives. 0 where faces_that_see() tells: only those who get the message need to know.
    std::uint8_t faces = 0;
    std::uint8_t emitters = 0;  // bit d: emitter d reaches it, of those asked about
};

class Visibility {
public:
    /// Sorts the robots by place. Call once per step before the queries.
    void update(World const& world);

    /// The robots that the given emitters of `robot` (bit d: emitter d) reach at a range of `range_mm`, each once,
    /// through the nearest emitter that sees it, in the order of their indices. An outline has one emitter, number 0.
    /// Robots that are switched off cover others, but receive nothing. Valid until the next call.
    std::span<Receiver const> receivers(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm);

    /// Vector from the centre of `robot`, which has a body, to the nearest point of the outline of `outline_robot`
    /// within `radius_mm`. None: there is no such point.
    std::optional<Vec2> to_outline(World const& world, std::uint32_t robot, std::uint32_t outline_robot,
                                   float radius_mm);

private:
    /// A robot that may be in reach, in the sender's own frame (x along its heading).
    struct Candidate {
        std::uint32_t robot;
        Vec2 offset_mm;
        float radius_mm;
        float nearest_mm2;     // squared distance from the nearest emitter that sees it
        Vec2 from_emitter_mm;  // in the sender's frame
        unsigned emitters;     // bit d: emitter d sees it
    };

    /// A candidate as one emitter sees it; `low` and `high` are the edges of its shadow, see diamond_angle().
    struct Sight {
        float distance_mm2;
        float low;
        float high;
        std::uint32_t candidate;
        Vec2 from_emitter_mm;  // x along the emitter's outward normal
    };

    struct Interval {
        float low;
        float high;
    };

    void find_receivers(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm);
    void gather_candidates(World const& world, std::uint32_t robot, float range_mm);
    void look(World const& world, std::uint32_t robot, int emitter, float range_mm);
    void add_outlines_near(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm);
    void add_robots_near(World const& world, std::uint32_t outline, float range_mm);
    std::uint8_t faces_near(World const& world, std::uint32_t robot, std::uint32_t outline, float range_mm);
    bool is_covered(Sight const& sight) const;
    void cover(Sight const& sight);

    OutlineIndex outlines_;
    std::vector<std::uint8_t> outline_emitters_;  // by outline: bit d: emitter d reaches it
    UniformGrid grid_;                            // of the robots with four emitters
    std::vector<std::uint32_t> robots_;           // their indices
    float largest_radius_mm_ = 0.0F;
    std::vector<Vec2> positions_;
    std::vector<Candidate> candidates_;
    std::vector<Sight> sights_;
    std::vector<Interval> shadows_;  // disjoint, in no order
    std::vector<Receiver> receivers_;
};

/// Distance of a robot's emitters from its centre, mm: 0 at the centre, or for an outline.
float emitter_radius_mm(World const& world, std::uint32_t robot);

/// Faces of `receiver` that see a point at `emitter_mm` (relative to the receiver's centre, in the world's axes) within
/// `range_mm`: bit d for face d. At least one: the face turned most towards the point.
std::uint8_t faces_that_see(World const& world, std::uint32_t receiver, Vec2 emitter_mm, float range_mm);

}  // namespace pogosim
