// Objects of type `passive_object`: a pushable body.
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/placement_keys.hpp"

namespace pogosim {

void read_passive_object(MapReader& reader, ObjectConfig& object) {
    read_shape(reader, solid_geometry_keys(), object.spec.shape);
    read_body(reader, object);
    read_placement(reader, object);
    read_colormap(reader, object);
}

}  // namespace pogosim
