// The springs of a membrane in groups of four that are solved at once, in the lanes of a register.
//
// The ring of dots is cut into four arcs, one for each lane: a row has the first dots of all arcs, the next row their
// second dots, and so on. A spring is stored in the row and lane of its end `a`.
//
//     row 0     0   20   40   60      A group joins the dots of a row to those of another row. Where springs cross
//     row 1     1   21   41   61      from one arc to the next, lanes are shifted: here, the group of springs from
//     ...                             row 19 to row 0 has the springs 19-20, 39-40, 59-60 and 79-0.
//     row 19   19   39   59   79
//
// No two springs of a group share a dot. Groups are in the order of their rows, but those of the first half of the rows
// and those of the second half take turns, so that few of them wait for the one before. One iteration over all of them
// takes an impulse along an eighth of the membrane.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/four.hpp"
#include "world/world.hpp"

namespace pogosim {

struct SpringGroup {
    std::array<std::uint32_t, kLanes> joint{kNone, kNone, kNone, kNone};  // into World::joints; kNone: no spring
    std::uint32_t row_a = 0;
    std::uint32_t row_b = 0;
    std::uint32_t shift = 0;  // lane l has the dot of lane (l + shift) % 4 of row_b
    // Values of the joints; 0 in lanes without a spring.
    Four length_mm{};
    Four longest_mm{};  // 0: no limit
    Four stiffness_hz{};
    Four damping_ratio{};
};

class SpringGroups {
public:
    /// `first_joint` and `joint_count`: the joints of the membrane in World::joints. Hinges are left out.
    SpringGroups(World const& world, Membrane const& membrane, std::uint32_t first_joint, std::uint32_t joint_count);

    std::uint32_t dot_count() const { return dot_count_; }
    std::uint32_t row_count() const { return row_count_; }
    std::vector<SpringGroup> const& groups() const { return groups_; }

    std::uint32_t row_of(std::uint32_t dot) const { return dot % row_count_; }
    std::uint32_t lane_of(std::uint32_t dot) const { return dot / row_count_; }

private:
    std::uint32_t dot_count_;
    std::uint32_t row_count_;
    std::vector<SpringGroup> groups_;
};

}  // namespace pogosim
