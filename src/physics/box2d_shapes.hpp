// Shapes of walls and bodies in Box2D, and what they weigh.
#pragma once

#include <box2d/box2d.h>

#include "geometry/polygon.hpp"
#include "geometry/shape.hpp"

namespace pogosim {

/// Adds a chain that pushes to one side: inwards for the arena's outer polygon, outwards for a hole. `fixture` gives
/// all but the shape. Throws ConfigError when the polygon (mm) is too small.
void add_wall(b2Body& body, Polygon const& polygon, bool outer, b2FixtureDef fixture);

/// Adds a solid shape around the body's origin and gives the body the shape's mass. `fixture` gives
/// all but the shape.
void add_shape(b2Body& body, Shape const& shape, b2FixtureDef fixture);

/// Sets the mass of a body, whose centre is its origin. Box2D's own way aborts at a polygon of less than 0.001 mm^2.
/// `gyration2`: square of the radius of gyration, units^2.
void set_mass(b2Body& body, float mass, float gyration2);

}  // namespace pogosim
