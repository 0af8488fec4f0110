// The parts of a robot as a configuration or a file of `robot_model` says them: faces, LEDs, light sensors, motors,
// flash memory and processor, see docs/robot_models.md.
#pragma once

#include <string_view>
#include <vector>

#include "config/map_reader.hpp"
#include "world/specs.hpp"

namespace pogosim {

/// Fills the robot's model from the keys that are there, and the speeds that its motors give. Robots keep their
/// defaults in all others.
void read_model(MapReader& reader, RobotSpec& robot);

/// Warns of places [x, y] beyond the bounding circle of the body, once these robots' shape is known.
void warn_of_parts_outside(MapReader const& reader, RobotModel const& model, float radius_mm);

/// Says what `max_angular_speed` means beside `motors`, once it has been read: a warning if they come from different
/// files. `of_motors_rad_s`: the fastest turn that read_model() has found.
void tell_of_turns(MapReader const& reader, RobotSpec const& robot, float of_motors_rad_s);

/// The tables of the maps in a model, for the configuration reference.
struct ModelTable {
    std::string_view name;
    std::string_view doc;
    std::vector<KeyDescription> keys;
};
std::vector<ModelTable> model_tables();

}  // namespace pogosim
