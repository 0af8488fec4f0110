#include "physics/step_start.hpp"

#include <algorithm>

namespace pogosim {

std::vector<std::uint32_t> moved_bodies(Bodies const& bodies) {
    std::vector<std::uint32_t> moved;
    for (WrittenBody const& written : bodies.written) {
        if (written.is_moved) {
            moved.push_back(written.body);
        }
    }
    std::ranges::sort(moved);
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    return moved;
}

}  // namespace pogosim
