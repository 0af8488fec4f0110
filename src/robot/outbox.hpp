// Messages and lines that the robots of one part of the swarm send and print while other threads run other parts. The
// parts are joined in the order of the robots, so that results do not depend on the number of workers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "world/mailbox.hpp"

namespace pogosim {

/// The key of a warning that a run gives only once. All parts are literals.
struct WarningKind {
    std::string_view text{};  // the format of the warning, or its last part
    std::string_view function{};
    std::string_view argument{};

    friend bool operator==(WarningKind const&, WarningKind const&) = default;
};

struct Outbox {
    struct Said {
        std::uint32_t robot = 0;  // index in World::robots
        WarningKind kind{};       // of a warning, see RunServices::warn_once(); empty: a line that it has printed
        std::string text{};
    };

    TransmissionQueue air;
    std::vector<Said> said;
    bool stop_requested = false;

    void clear() {
        air.clear();
        said.clear();
        stop_requested = false;
    }
};

}  // namespace pogosim
