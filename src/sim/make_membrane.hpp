// Soft membranes: the bodies of a membrane and the joints between them.
#pragma once

#include <vector>

#include "geometry/formation.hpp"
#include "world/world.hpp"

namespace pogosim {

struct MembraneBody {
    Vec2 position_mm;
    float heading_rad = 0.0F;
    Shape shape;
};

struct MembraneParts {
    std::vector<MembraneBody> bodies;  // along the outline, clockwise on the screen
    std::vector<Joint> joints;         // between them: a and b are indices into `bodies`
};

/// Line through the middle of the membrane's bodies: through the centres of disks, along segments from hinge to hinge.
Polygon membrane_line(ObjectSpec const& spec, Placement const& placement);

/// The membrane of an object with `spec.membrane` at this place. Its bodies lie within the shape's outline and touch
/// it.
MembraneParts make_membrane(ObjectSpec const& spec, Placement const& placement);

/// Radius of the disk around the centre that holds the object, mm: that of its shape, and more when a membrane's bodies
/// are too thick to lie within it.
float outer_radius_mm(ObjectSpec const& spec);

/// Half the thickness of a membrane, mm.
float half_thickness_mm(MembraneSpec const& membrane);

/// Widest free gap between neighbouring bodies of the membrane, mm; 0 when they touch. A smaller robot may slip
/// through.
float widest_gap_mm(MembraneParts const& membrane);

}  // namespace pogosim
