// A robot may change the mode of the floating-point unit; the world must not depend on that, nor the other robots. So
// the simulator restores the mode before it computes anything after user code has run.
#pragma once

#include "base/floating_point.hpp"

namespace pogosim {

/// Warns once.
[[gnu::cold]] void take_back_changed_floating_point();

inline void take_back_floating_point() {
    if (floating_point_mode() != kStandardMode) [[unlikely]] {
        take_back_changed_floating_point();
    }
}

}  // namespace pogosim
