// Objects of type `active_object`: a pushable body with a program and infrared, but no motors.
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/placement_keys.hpp"

namespace pogosim {

void read_active_object(MapReader& reader, ObjectConfig& object) {
    read_shape(reader, solid_geometry_keys(), object.spec.shape);
    RobotSpec kind;
    kind.has_wheels = false;
    read_robot(reader, object, kind);
    read_body(reader, object);
    read_placement(reader, object);
    read_colormap(reader, object);
}

}  // namespace pogosim
