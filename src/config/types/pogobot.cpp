// Objects of type `pogobot`.
#include "config/object_parts.hpp"
#include "config/object_types.hpp"

namespace pogosim {

void read_pogobot(MapReader& reader, ObjectConfig& object) {
    read_shape(reader, solid_geometry_keys(), object.spec.shape);
    read_robot(reader, object);
    read_body(reader, object);
    read_position(reader, object);
}

}  // namespace pogosim
