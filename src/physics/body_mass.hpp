// What bodies weigh. The unit of mass inside the engines: body_density, in kg per (100 mm)^2, times an area in mm^2.
#pragma once

#include "geometry/shape.hpp"

namespace pogosim {

inline constexpr float kMassPerKg = 1e4F;

/// From N to mass mm/s^2.
inline constexpr float kForcePerNewton = 1e3F * kMassPerKg;

/// What a body's density has to be multiplied by.
struct ShapeMass {
    float area_mm2;
    float gyration_mm2;  // moment of inertia about the origin, per mass
};
ShapeMass mass_of(Shape const& shape);

}  // namespace pogosim
