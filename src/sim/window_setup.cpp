#include "sim/window_setup.hpp"

#include <fmt/format.h>

#include "pogosim/version.h"
#include "sim/pictures.hpp"

namespace pogosim {

WindowSetup window_setup(Scenario const& scenario, World const& world, std::string const& program_name) {
    WindowSetup setup;
    std::string const name = program_name.empty() ? "" : program_name + " - ";
    setup.title = fmt::format("{}Pogosim {}", name, POGOSIM_VERSION_STRING);
    PictureFormat const format = picture_format(scenario, world);
    setup.size = format.size;
    setup.options = format.paint;
    setup.duration_s = scenario.simulation_time_s;
    setup.time_step_s = world.time_step_s;
    setup.speed_up = scenario.view.gui_speed_up;
    return setup;
}

}  // namespace pogosim
