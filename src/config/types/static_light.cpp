// Objects of type `static_light`.
#include "config/lamp_keys.hpp"
#include "config/object_parts.hpp"
#include "config/object_types.hpp"

namespace pogosim {

void read_static_light(MapReader& reader, ObjectConfig& object) {
    SpotSpec spec;
    read_shape(reader, any_geometry_keys(), spec.shape);
    read_spot(reader, spec);
    if (has_place(spec)) {
        warn_of_lone_coordinate(reader, "x", "y", spec.centre_mm);
    }
    object.spec.lamp = spec;
}

}  // namespace pogosim
