// From the arena to the pixels and back.
#pragma once

#include "base/vec2.hpp"

namespace pogosim {

struct PictureSize {
    int width_px = 800;
    int height_px = 800;

    constexpr Vec2 middle_px() const {
        return {0.5F * static_cast<float>(width_px), 0.5F * static_cast<float>(height_px)};
    }
    friend bool operator==(PictureSize const&, PictureSize const&) = default;
};

struct Camera {
    Vec2 centre_mm;         // in the middle of the picture
    float scale_px_mm = 1;  // pixels per mm

    constexpr Vec2 to_pixels(Vec2 point_mm, PictureSize size) const {
        return scale_px_mm * (point_mm - centre_mm) + size.middle_px();
    }
    constexpr Vec2 to_mm(Vec2 point_px, PictureSize size) const {
        return (1.0F / scale_px_mm) * (point_px - size.middle_px()) + centre_mm;
    }

    friend bool operator==(Camera const&, Camera const&) = default;
};

/// Share of the picture that a fitted arena fills along its longer side.
inline constexpr float kFitMargin = 0.95F;

/// The whole arena in the middle of the picture.
Camera fitted(Box const& bounds_mm, PictureSize size);

/// Scales from which to which a window zooms, pixels per mm.
struct ZoomLimits {
    float least_px_mm = 0.1F;
    float most_px_mm = 10.0F;
};

/// 0.1 to 10 pixels per mm, and further where the arena does not fit otherwise.
ZoomLimits zoom_limits(Box const& bounds_mm, PictureSize size);

/// Zoomed by a factor, the point under `fixed_px` staying where it is.
Camera zoomed(Camera const& camera, float factor, Vec2 fixed_px, PictureSize size, ZoomLimits limits);

}  // namespace pogosim
