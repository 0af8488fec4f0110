// Objects of type `pogobot`.
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/placement_keys.hpp"

namespace pogosim {

void read_pogobot(MapReader& reader, ObjectConfig& object) {
    object.spec.shape = kPogobotShape;
    read_shape(reader, robot_geometry_keys(), object.spec.shape);
    read_robot(reader, object);
    read_body(reader, object);
    read_placement(reader, object);
}

}  // namespace pogosim
