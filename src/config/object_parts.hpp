// The keys that types of objects share, one function for each part an object can have. A type is the list of its parts.
#pragma once

#include <span>

#include "config/map_reader.hpp"
#include "config/scenario.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

/// `body_*`: makes the object tangible.
void read_body(MapReader& reader, ObjectConfig& object);

/// `blocks_infrared` of an object whose body has been read.
void read_blocking(MapReader& reader, ObjectConfig& object);

/// Motors, sensors, infrared: the object runs user code. `model`: what objects of this type have.
void read_robot(MapReader& reader, ObjectConfig& object, RobotModel const& model = {});

/// The map `battery` of a robot; the caller finishes the reader.
BatterySpec read_battery_map(MapReader& reader);

/// `x` and `y`, both or neither.
void read_position(MapReader& reader, ObjectConfig& object);

/// `x` and `y` of an object to which they do not apply.
void ignore_position(MapReader& reader);

/// `colormap`.
void read_colormap(MapReader& reader, ObjectConfig& object);

}  // namespace pogosim
