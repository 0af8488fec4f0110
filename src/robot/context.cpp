#include "robot/context.hpp"

#include <algorithm>

#include "base/log.hpp"

namespace pogosim {

constinit thread_local Context context;

bool RunServices::is_new(std::string_view format) const {
    return std::ranges::find(warned, format) == warned.end();
}

void RunServices::warn_of_robot(std::string_view format, std::string const& text) {
    std::string const warning = fmt::format("{}: {}", current_robot_name(), text);
    if (context.outbox == nullptr) {
        warn_first(format, warning);
        return;
    }
    std::vector<Outbox::Said>& said = context.outbox->said;
    if (std::ranges::find(said, format, &Outbox::Said::format) == said.end()) {
        said.push_back({.robot = context.robot, .format = format, .text = warning});
    }
}

void RunServices::warn_first(std::string_view format, std::string const& text) {
    if (is_new(format)) {
        warned.push_back(format);
        log().warn("{}", text);
    }
}

void RunServices::print_line(World const& world, std::uint32_t robot, std::string_view line) {
    robot_log().info("[ROBOT #{}] [PRINTF] {}", robot == kNone ? std::uint16_t{0} : id_on_air(world.robots.id[robot]),
                     line);
    if (printed_lines != nullptr) {
        printed_lines->add(robot, line);
    }
}

RunningRobot running_robot() {
    return {.its_context = context, .ticks = pogobot_ticks};
}

void set_running_robot(RunningRobot const& robot) {
    context = robot.its_context;
    pogobot_ticks = robot.ticks;
}

std::string current_place() {
    return context.is_system ? current_robot_name()
                             : fmt::format("{} of {}", name_of(context.phase), current_robot_name());
}

std::string current_robot_name() {
    std::string const tick = has_ticks(context.phase) ? fmt::format(", tick {}", pogobot_ticks) : "";
    if (context.is_system) {
        return fmt::format("{}{}", name_of(context.phase), tick);
    }
    World const& world = *context.world;
    return fmt::format("robot #{} of category '{}'{}", world.robots.id[context.robot],
                       world.categories[world.robots.category[context.robot]].name, tick);
}

}  // namespace pogosim
