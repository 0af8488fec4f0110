#include "robot/context.hpp"

#include <algorithm>

#include "base/log.hpp"

namespace pogosim {

constinit thread_local Context context;

bool RunServices::is_first(std::string_view format) {
    bool const first = std::find(warned.begin(), warned.end(), format) == warned.end();
    if (first) {
        warned.push_back(format);
    }
    return first;
}

void RunServices::warn_of_robot(std::string const& text) {
    log().warn("{}: {}", current_robot_name(), text);
}

std::string current_place() {
    return context.is_system ? current_robot_name()
                             : fmt::format("{} of {}", name_of(context.phase), current_robot_name());
}

std::string current_robot_name() {
    if (context.is_system) {
        return fmt::format("{}, tick {}", name_of(context.phase), pogobot_ticks);
    }
    World const& world = *context.world;
    return fmt::format("robot #{} of category '{}', tick {}", world.robots.id[context.robot],
                       world.categories[world.robots.category[context.robot]].name, pogobot_ticks);
}

}  // namespace pogosim
