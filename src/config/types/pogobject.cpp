// Objects of type `pogobject`: the head of a robot on a large body without motors.
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/placement_keys.hpp"

namespace pogosim {

void read_pogobject(MapReader& reader, ObjectConfig& object) {
    read_shape(reader, solid_geometry_keys(), object.spec.shape);
    read_robot(reader, object);
    object.spec.robot->has_wheels = false;
    object.spec.robot->emitters = Emitters::centre;
    read_body(reader, object);
    read_placement(reader, object);
}

}  // namespace pogosim
