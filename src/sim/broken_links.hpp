// Tells users that links have broken.
#pragma once

#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

class BrokenLinks {
public:
    /// Before the step of the engine: what is cut now was cut by a program or a host.
    void note(World const& world);

    /// After it: what has been cut in it has broken. Logs the first link of each category that does.
    void tell(World const& world);

private:
    std::uint32_t changes_ = 0;     // World::link_changes when links were last looked at
    std::vector<bool> is_cut_;      // each link
    std::vector<bool> has_broken_;  // each category
};

}  // namespace pogosim
