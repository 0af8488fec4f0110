#include "sim/gdb_of_run.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <variant>

#include "base/error.hpp"
#include "base/escaped.hpp"
#include "process/crash_handler.hpp"
#include "world/brain_spec.hpp"

namespace pogosim {

namespace {

bool runs_firmware(World const& world, std::uint32_t robot) {
    return std::holds_alternative<FirmwareSpec>(world.spec_of(robot).brain);
}

std::uint32_t robot_to_debug(World const& world, std::optional<std::uint32_t> id) {
    auto const count = static_cast<std::uint32_t>(world.robots.size());
    for (std::uint32_t robot = 0; robot < count; ++robot) {
        bool const is_meant = id ? world.robots.id[robot] == *id : runs_firmware(world, robot);
        if (is_meant && runs_firmware(world, robot)) {
            return robot;
        }
        if (is_meant) {
            throw ConfigError(
                fmt::format("--gdb-robot: robot #{} of category '{}' runs no firmware, so that there is "
                            "nothing to debug here; choose another one, or debug the simulator itself",
                            *id, escaped(world.categories[world.robots.category[robot]].name)));
        }
    }
    throw ConfigError(id ? fmt::format("--gdb-robot: there is no robot #{}", *id)
                         : "--gdb: no robot runs firmware (--firmware FILE, or brain: FILE of a category)");
}

}  // namespace

std::unique_ptr<GdbSession> gdb_of_run(World const& world, GdbOptions const& options) {
    std::uint32_t const index = robot_to_debug(world, options.robot);
    GdbRobot robot;
    robot.index = index;
    robot.id = world.robots.id[index];
    robot.category = world.categories[world.robots.category[index]].name;
    robot.firmware = std::get<FirmwareSpec>(world.spec_of(index).brain).file;
    robot.time = [&world, index] {
        constexpr double kSecondsPerUs = 1e-6;
        return fmt::format("t = {:.4f} s, its clock {:.6f} s, tick {}", world.time_s(),
                           static_cast<double>(world.devices.clock_us[index]) * kSecondsPerUs,
                           world.devices.ticks[index]);
    };
    robot.interrupted = interrupted;
    robot.end_run = [&ends_run = options.ends_run] { ends_run = true; };
    return std::make_unique<GdbSession>(std::move(robot), options.port);
}

}  // namespace pogosim
