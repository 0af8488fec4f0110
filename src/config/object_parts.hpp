// The keys that types of objects share, one function for each part an object can have. A type is the list of its parts.
// Parts with many keys have a file each: placement_keys.cpp, brain_keys.cpp, function_costs.cpp, model_keys.cpp and
// reception_keys.cpp.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "config/map_reader.hpp"
#include "config/scenario.hpp"
#include "config/shape_keys.hpp"
#include "world/brain_spec.hpp"
#include "world/processor_spec.hpp"
#include "world/specs.hpp"

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

// Keys that place the objects of one category: `poses`, or an `area` and an `initial_formation` of its own.

/// Where the objects of a category with a body start: `x`, `y` and `angle`, or `poses`, or `area` and
/// `initial_formation`; without any of these, the common formation places them. `poses` also says how many there are
/// when `nb` is absent.
void read_placement(MapReader& reader, ObjectConfig& object);

/// `area` as a disk, for the reference: `x`, `y` and `radius`.
Polygon read_disk_area(MapReader& reader);

// The key `brain` of a category: what drives its robots, see docs/brains.md.

/// The key itself, for messages and the configuration reference.
std::span<Key<RobotSpec> const> brain_keys();

/// `program`, `host`, a firmware, or a map with a script; without the key, a program. Throws ConfigError.
BrainSpec read_brain(MapReader& robot, RobotModel const& model);

/// The keys of a map with a firmware, and of an entry of a script, for the configuration reference.
std::vector<KeyDescription> firmware_map_keys();
std::vector<KeyDescription> script_entry_keys();

// The key `function_costs` of a category: what the functions of a program in C take on the robot's processor.

inline constexpr std::string_view kFunctionCosts = "the name of a file with a map `function_costs`, or that map";

/// Without the key, none. Throws ConfigError.
std::vector<FunctionCost> read_function_costs(MapReader& robot);

/// The keys of one function, for the configuration reference.
std::vector<KeyDescription> function_cost_keys();

// The parts of a robot as a configuration or a file of `robot_model` says them: faces, LEDs, light sensors, motors,
// flash memory and processor, see docs/robot_models.md.

/// Fills the robot's model from the keys that are there, and the speeds that its motors give. Robots keep their
/// defaults in all others.
void read_model(MapReader& reader, RobotSpec& robot);

/// Warns of places [x, y] beyond the bounding circle of the body, once these robots' shape is known.
void warn_of_parts_outside(MapReader const& reader, RobotModel const& model, float radius_mm);

/// What the motors of a robot give together, as read_model() has found it.
struct MotorSpeeds {
    float linear_mm_s = 0.0F;
    float angular_rad_s = 0.0F;
};

/// Says what `max_linear_speed` and `max_angular_speed` mean beside `motors`, once they have been read: a warning if
/// they come from another file. What the motors do not do, no key makes them do.
void tell_of_speeds(MapReader& reader, RobotSpec& robot, MotorSpeeds const& of_motors);

/// The tables of the maps in a model, for the configuration reference.
struct ModelTable {
    std::string_view name;
    std::string_view doc;
    std::vector<KeyDescription> keys;
};
std::vector<ModelTable> model_tables();

// `msg_success_rate`: the probability that a message is received.

inline constexpr std::string_view kReceptionMap = "a map of keys, such as {type: static, rate: 0.9}";

/// The law a robot's `msg_success_rate` asks for; `robot` reads the map it stands in.
///
///   absent      the article's equation with its defaults
///   static      P = rate
///   realistic   the four-parameter law with its own defaults, whatever else the map holds
///   dynamic     with alpha, beta, gamma or delta, but neither zeta nor theta: the four-parameter law;
///               otherwise the article's equation. Parameters that are not given have the defaults of the law.
ReceptionSpec read_reception(MapReader& robot);

/// The same from the map `msg_success_rate` itself; the caller finishes the reader.
ReceptionSpec read_reception_map(MapReader& reader);

}  // namespace pogosim
