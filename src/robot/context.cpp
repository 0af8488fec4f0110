#include "robot/context.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/log.hpp"

namespace pogosim {

constinit thread_local Context context;

void RunServices::warn_once(char const* text) {
    if (std::find(warned.begin(), warned.end(), text) == warned.end()) {
        warned.push_back(text);
        log().warn("{}: {}", current_robot_name(), text);
    }
}

std::string current_place() {
    return context.is_system ? current_robot_name() : fmt::format("{} of {}", context.phase, current_robot_name());
}

std::string current_robot_name() {
    if (context.is_system) {
        return fmt::format("{}, tick {}", context.phase, pogobot_ticks);
    }
    World const& world = *context.world;
    return fmt::format("robot #{} of category '{}', tick {}", world.robots.id[context.robot],
                       world.categories[world.robots.category[context.robot]].name, pogobot_ticks);
}

}  // namespace pogosim
