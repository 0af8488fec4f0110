// Kinds of links between bodies, as hosts name them.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "base/error.hpp"
#include "pogosim/host.h"
#include "world/world.hpp"

namespace pogosim {

/// The kind of a number of enum pogosim_run_link_kind. Throws ConfigError; `expected` begins its message.
inline LinkKind link_kind_of(std::int32_t kind, std::string_view expected) {
    switch (kind) {
        case POGOSIM_RUN_SPRING:
            return LinkKind::spring;
        case POGOSIM_RUN_ROD:
            return LinkKind::rod;
        case POGOSIM_RUN_HINGE:
            return LinkKind::hinge;
        default:
            throw ConfigError(fmt::format("{} 0 (spring), 1 (rod) or 2 (hinge), found {}", expected, kind));
    }
}

}  // namespace pogosim
