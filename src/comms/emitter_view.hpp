// The line of sight from a robot's emitters to the robots around it.
//
//                front (0)
//               .---^---.
//              |         |
//    left (3) <           > right (1)
//              |         |
//               '---v---'
//                back (2)
//
// The emitters of a Pogobot sit on the rim at 0, 90, 180 and 270 degrees, and radiate over the half plane in front of
// them; a robot's model may have other places and narrower cones. An emitter reaches another robot when that robot's
// border is within range of the emitter, its centre lies in the cone, and nearer robots that the emitter sees leave at
// least a part of it uncovered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/four.hpp"
#include "base/vec2.hpp"
#include "comms/faces.hpp"

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

    /// Finds the added robots that the given emitters (bit d: the emitter of face d) see within `range_mm`. With
    /// `ignore_occlusions`, emitters radiate in all directions, through everything.
    std::span<Candidate const> look(unsigned emitters, Faces const& faces, float range_mm, bool ignore_occlusions);

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
Vec2 from_nearest_emitter_mm(EmitterView::Candidate const& candidate, Faces const& faces);

}  // namespace pogosim
