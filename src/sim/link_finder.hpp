// Which robots hear which others now, for pictures.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "comms/visibility.hpp"
#include "render/snapshot.hpp"
#include "world/world.hpp"

namespace pogosim {

class LinkFinder {
public:
    /// One link for each pair of robots of which at least one reaches the other with any of its emitters, whatever it
    /// sends: the robots that would receive a message if none were lost. Sorted by `from`, then `to`; `from` is the
    /// smaller index when both reach each other, and else the one that is heard. `range_mm`: by robot, 0: mute.
    std::vector<InfraredLink> find(World const& world, std::span<float const> range_mm);

private:
    /// One direction of a link.
    struct Reach {
        std::uint32_t to = 0;
        std::uint8_t emitters = 0;
    };

    std::uint8_t emitters_between(std::uint32_t from, std::uint32_t to) const;
    void place(World const& world, float range_mm, InfraredLink& link);

    Visibility visibility_;
    std::vector<Reach> reached_;        // by sender, then by receiver
    std::vector<std::uint32_t> start_;  // of each sender in reached_, one more at the end
};

}  // namespace pogosim
