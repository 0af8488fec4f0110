// Objects of type `pogobject`: the head of a robot on a large body without motors.
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/placement_keys.hpp"

namespace pogosim {

void read_pogobject(MapReader& reader, ObjectConfig& object) {
    read_shape(reader, solid_geometry_keys(), object.spec.shape);
    RobotSpec kind;
    kind.emitters = Emitters::centre;
    kind.has_wheels = false;
    read_robot(reader, object, kind);
    read_body(reader, object);
    read_placement(reader, object);
}

}  // namespace pogosim
