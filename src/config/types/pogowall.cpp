// Objects of type `pogowall`: an outline, usually the arena's, that sends and receives along its whole length.
#include "config/object_parts.hpp"
#include "config/object_types.hpp"

namespace pogosim {

void read_pogowall(MapReader& reader, ObjectConfig& object) {
    read_shape(reader, outline_geometry_keys(), object.spec.shape);
    read_robot(reader, object);
    object.spec.robot->has_wheels = false;
    object.spec.robot->emitters = Emitters::outline;
    read_position(reader, object);
    if (object.spec.shape.kind == ShapeKind::arena) {
        object.position_mm.reset();
    } else if (!object.position_mm && reader.find("geometry") != nullptr) {
        fail_at(reader.place(), "needs x and y: no formation places a wall of this geometry");
    }
}

}  // namespace pogosim
