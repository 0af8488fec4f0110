// The line of sight from a robot's four emitters to the robots around it, and from an emitter to a robot's faces.
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
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/four.hpp"
#include "base/vec2.hpp"
#include "world/mailbox.hpp"

namespace pogosim {

class EmitterView {
public:
    /// A robot that may be in range, in the sender's own frame (x along its heading).
    struct Candidate {
        Vec2 offset_mm;
        float radius_mm = 0.0F;
        std::uint32_t robot = 0;
        unsigned emitters = 0;  // bit d: emitter d sees it
    };

    void clear() { count_ = 0; }
    /// Makes room for `count` more candidates.
    void expect(std::size_t count) {
        if (candidates_.size() < count_ + count) {
            candidates_.resize(2 * (count_ + count));
        }
    }
    /// Adds a candidate if `is_candidate`: branch-free, since the branch could not be predicted.
    void add_if(bool is_candidate, std::uint32_t robot, Vec2 offset_mm, float radius_mm) {
        candidates_[count_] = {offset_mm, radius_mm, robot, 0};
        count_ += is_candidate ? 1 : 0;
    }

    /// Finds the added robots that the given emitters (bit d: emitter d), `rim_mm` from the centre, see within
    /// `range_mm`. With `ignore_occlusions`, emitters radiate in all directions, through everything.
    std::span<Candidate const> look(unsigned emitters, float rim_mm, float range_mm, bool ignore_occlusions);

private:
    /// A candidate in view of an emitter, before occlusion by others.
    struct Sight {
        float distance_mm2;
        std::uint32_t candidate;
        Vec2 seen_mm;  // x along the emitter's outward normal
    };

    /// A candidate as the four emitters see it.
    struct Views {
        FourInts is_in_view;
        Four x;  // of its centre, along the emitter's outward normal
        Four y;
        Four distance_mm2;
        Four shadow_mm2;  // square of the half width of its shadow at the candidate, rounded up
    };

    /// Edges of a shadow, see diamond_angle().
    struct Interval {
        float low;
        float high;
    };

    void look_ahead(unsigned emitter);
    unsigned emitters_with_shadows() const;
    bool is_covered(Interval const& sight) const;
    void cover(Interval const& sight);

    std::vector<Candidate> candidates_;  // the first count_ of these
    std::size_t count_ = 0;
    std::vector<Views> views_;       // of the candidates
    std::vector<Sight> sights_;      // of one emitter, from near to far
    std::vector<Interval> shadows_;  // disjoint, unsorted
};

/// Vector from the nearest of the emitters that see a candidate to its centre, in the sender's frame.
Vec2 from_nearest_emitter_mm(EmitterView::Candidate const& candidate, float rim_mm);

/// Faces of a robot that see a point at `emitter_mm` (relative to the robot's centre, in its own frame) within
/// `range_mm`, when they are `rim_mm` from the centre: bit d for face d. Never none: if no face
/// sees the point, the face that points most towards it.
std::uint8_t faces_that_see(Vec2 emitter_mm, float rim_mm, float range_mm);

}  // namespace pogosim
