#include "config/old_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace pogosim {

namespace {

struct OldName {
    std::string_view old_path;
    std::string_view new_path;
};

constexpr std::array kOldNames{
    OldName{"nBots", "objects.<category>.nb"},
    OldName{"commRadius", "objects.<category>.communication_radius"},
    OldName{"msgSuccessRate", "objects.<category>.msg_success_rate"},
    OldName{"robot_radius", "objects.<category>.radius"},
    OldName{"initial_robot_formation", "initial_formation"},
    OldName{"initial_light_value", "objects.<light>.value"},
    OldName{"showComms", "show_communication_channels"},
    OldName{"simulationTime", "simulation_time"},
    OldName{"timeStep", "time_step"},
    OldName{"photo_start_at", "objects.<light>.photo_start_at"},
    OldName{"photo_start_duration", "objects.<light>.photo_start_duration"},
};

}  // namespace

std::string new_place(std::string_view path) {
    auto const old = std::ranges::find(kOldNames, path, &OldName::old_path);
    return old == kOldNames.end() ? "" : fmt::format("; it is now '{}'", old->new_path);
}

std::vector<std::string> old_keys(Node const& root) {
    std::vector<std::string> found;
    for (Node::Entry const& entry : root.entries) {
        if (std::ranges::find(kOldNames, entry.key, &OldName::old_path) != kOldNames.end()) {
            found.push_back(entry.key);
        }
    }
    return found;
}

}  // namespace pogosim
