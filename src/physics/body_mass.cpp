#include "physics/body_mass.hpp"

#include <algorithm>
#include <numbers>

namespace pogosim {

namespace {

constexpr double kLeastAreaMm2 = 1e-12;  // the area of a speck would be rounded to 0

}  // namespace

ShapeMass mass_of(Shape const& shape) {
    if (shape.kind == ShapeKind::disk) {
        float const squared_mm2 = shape.radius_mm * shape.radius_mm;
        return {std::numbers::pi_v<float> * squared_mm2, 0.5F * squared_mm2};
    }
    AreaMoments const moments = moments_of(shape);
    double const area_mm2 = std::max(moments.area_mm2, kLeastAreaMm2);
    return {static_cast<float>(area_mm2),
            static_cast<float>(std::max(moments.polar_mm4, kLeastAreaMm2 * kLeastAreaMm2) / area_mm2)};
}

}  // namespace pogosim
