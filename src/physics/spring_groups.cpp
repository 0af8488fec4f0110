#include "physics/spring_groups.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace pogosim {

SpringGroups::SpringGroups(World const& world, Membrane const& membrane, std::uint32_t first_joint,
                           std::uint32_t joint_count)
    : dot_count_(membrane.body_count), row_count_((membrane.body_count + kLanes - 1) / kLanes) {
    std::vector<std::uint32_t> joints(joint_count);
    std::iota(joints.begin(), joints.end(), first_joint);
    std::erase_if(joints, [&](std::uint32_t i) { return world.joints[i].length_mm == 0.0F; });
    std::uint32_t const half = (row_count_ + 1) / 2;
    auto const place_of = [&](std::uint32_t i) {
        std::uint32_t const row = row_of(world.joints[i].a - membrane.body);
        return std::pair(row % half, row / half);
    };
    std::ranges::stable_sort(joints, {}, place_of);
    std::size_t first_of_row = 0;
    for (std::uint32_t const i : joints) {
        Joint const& joint = world.joints[i];
        std::uint32_t const a = joint.a - membrane.body;
        std::uint32_t const b = joint.b - membrane.body;
        std::uint32_t const lane = lane_of(a);
        std::uint32_t const shift = (lane_of(b) + kLanes - lane) % kLanes;
        if (!groups_.empty() && groups_.back().row_a != row_of(a)) {
            first_of_row = groups_.size();
        }
        // Within a row, springs of different lanes may share a dot.
        auto const takes = [&](SpringGroup const& group) {
            return group.row_b == row_of(b) && group.shift == shift && group.joint[lane] == kNone &&
                   group.row_a != group.row_b;
        };
        auto group = std::find_if(groups_.begin() + static_cast<std::ptrdiff_t>(first_of_row), groups_.end(), takes);
        if (group == groups_.end()) {
            groups_.push_back({.row_a = row_of(a), .row_b = row_of(b), .shift = shift});
            group = groups_.end() - 1;
        }
        group->joint[lane] = i;
        group->length_mm[lane] = joint.length_mm;
        group->longest_mm[lane] = (1.0F + joint.max_stretch) * joint.length_mm * (joint.max_stretch > 0.0F);
        group->stiffness_hz[lane] = joint.stiffness_hz;
        group->damping_ratio[lane] = joint.damping_ratio;
    }
}

}  // namespace pogosim
