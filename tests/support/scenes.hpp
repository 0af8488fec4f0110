// Scenes that tests and benchmarks share: configurations made in code, without a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/scenario.hpp"
#include "sim/simulation.hpp"

namespace pogosim::testing {

/// The article's robot: 26.5 mm, 100 mm/s, 2 rad/s, no noise, messages always received.
inline ObjectSpec article_robot() {
    ObjectSpec spec;
    spec.shape.radius_mm = 26.5F;
    spec.body.emplace();
    RobotSpec& robot = spec.robot.emplace();
    robot.max_linear_speed_mm_s = 100.0F;
    robot.max_angular_speed_rad_s = 2.0F;
    robot.ir.reception = {.law = ReceptionLaw::constant, .rate = 1.0};
    return spec;
}

inline ObjectConfig robots(int nb, ObjectSpec const& spec = article_robot(), std::string const& category = "robots") {
    ObjectConfig object;
    object.category = category;
    object.type = "pogobot";
    object.nb = nb;
    object.spec = spec;
    return object;
}

inline ObjectConfig robot_at(Vec2 position_mm, ObjectSpec const& spec = article_robot(),
                             std::string const& category = "robots") {
    ObjectConfig object = robots(1, spec, category);
    object.position_mm = position_mm;
    return object;
}

inline ObjectConfig lamp(LampSpec const& spec) {
    ObjectConfig object;
    object.category = "light";
    object.type = "static_light";
    object.spec.lamp = spec;
    return object;
}

/// A square of the given side without data file, placing at random.
inline Scenario square_scene(std::vector<ObjectConfig> objects, double side_mm = 1000.0) {
    Scenario scenario;
    scenario.arena_file = std::string(POGOSIM_SOURCE_DIR) + "/arenas/square.csv";
    scenario.arena_surface_mm2 = side_mm * side_mm;
    scenario.simulation_time_s = 1000.0;
    scenario.seed = 1;
    scenario.formation.name = "random";
    scenario.output.enable_data_logging = false;
    scenario.objects = std::move(objects);
    return scenario;
}

/// Steps until so much simulated time is over. Returns the first failure of user code.
inline std::optional<UserFailure> run_for(Simulation& simulation, double seconds) {
    double const end = simulation.world().time_s() + seconds - 1e-9;
    while (simulation.world().time_s() < end) {
        if (auto failure = simulation.step()) {
            return failure;
        }
    }
    return std::nullopt;
}

}  // namespace pogosim::testing
