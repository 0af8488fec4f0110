// Where a lamp stands at one moment, for pictures.
#pragma once

#include "geometry/shape.hpp"

namespace pogosim {

/// A lamp with a place.
struct LampMark {
    Vec2 centre_mm;         // where it stands
    Shape shape{};          // the area that it can light; global and arena: no outline
    Vec2 shape_mm{};        // where the shape's centre is; alternating rays stand at its corners
    bool has_beam = false;  // a lighthouse
    float beam_rad = 0.0F;  // direction of its beam, if it is on
    bool beam_is_on = false;
};

}  // namespace pogosim
