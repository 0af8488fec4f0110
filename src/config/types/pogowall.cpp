// Objects of type `pogowall`: an outline, usually the arena's, that sends and receives along its whole length.
#include "config/object_parts.hpp"
#include "config/object_types.hpp"

namespace pogosim {

void read_pogowall(MapReader& reader, ObjectConfig& object) {
    read_shape(reader, outline_geometry_keys(), object.spec.shape);
    RobotSpec kind;
    kind.emitters = Emitters::outline;
    kind.has_wheels = false;
    read_robot(reader, object, kind);
    if (object.spec.shape.kind == ShapeKind::arena) {
        ignore_position(reader);
        return;
    }
    read_position(reader, object);
    if (!object.position_mm && reader.find("geometry") != nullptr) {
        fail_at(reader.place(), "needs x and y: no formation places a wall of this geometry");
    }
}

}  // namespace pogosim
