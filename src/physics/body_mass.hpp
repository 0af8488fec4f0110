// The unit of mass inside the engines: body_density, in kg per (100 mm)^2, times an area in mm^2.
#pragma once

namespace pogosim {

inline constexpr float kMassPerKg = 1e4F;

/// From N to mass mm/s^2.
inline constexpr float kForcePerNewton = 1e3F * kMassPerKg;

}  // namespace pogosim
