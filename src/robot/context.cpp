#include "robot/context.hpp"

#include <algorithm>

#include "base/log.hpp"

namespace pogosim {

constinit thread_local Context context;

bool RunServices::is_new(WarningKind const& kind) const {
    return std::ranges::find(warned, kind) == warned.end();
}

void RunServices::warn_of_robot(WarningKind const& kind, std::string const& text) {
    std::string const time = has_ticks(context.phase) ? fmt::format(", t = {:.4f} s", context.world->time_s()) : "";
    std::string const warning = fmt::format("{}{}: {}", current_robot_name(), time, text);
    if (context.outbox == nullptr) {
        warn_first(kind, warning);
        return;
    }
    std::vector<Outbox::Said>& said = context.outbox->said;
    if (std::ranges::find(said, kind, &Outbox::Said::kind) == said.end()) {
        said.push_back({.robot = context.robot, .kind = kind, .text = warning});
    }
}

void RunServices::warn_first(WarningKind const& kind, std::string const& text) {
    if (is_new(kind)) {
        warned.push_back(kind);
        log().warn("{}", text);
    }
}

void RunServices::print_line(World const& world, std::uint32_t robot, std::string_view line) {
    if (are_lines_hidden) {
        return;
    }
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
