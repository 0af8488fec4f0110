#include "render/camera.hpp"

#include <algorithm>

namespace pogosim {

Camera fitted(Box const& bounds_mm, PictureSize size) {
    Vec2 const extent = bounds_mm.size();
    float const across = static_cast<float>(size.width_px) / extent.x;
    float const down = static_cast<float>(size.height_px) / extent.y;
    float const scale = kFitMargin * std::min(across, down);
    bool const is_possible = std::isfinite(scale) && scale > 0.0F;  // not of an empty box, nor into an empty picture
    return {bounds_mm.centre(), is_possible ? scale : 1.0F};
}

ZoomLimits zoom_limits(Box const& bounds_mm, PictureSize size) {
    float const fit = fitted(bounds_mm, size).scale_px_mm;
    ZoomLimits limits;
    limits.least_px_mm = std::min(limits.least_px_mm, fit);
    limits.most_px_mm = std::max(limits.most_px_mm, fit);
    return limits;
}

Camera zoomed(Camera const& camera, float factor, Vec2 fixed_px, PictureSize size, ZoomLimits limits) {
    float const scale = std::clamp(camera.scale_px_mm * factor, limits.least_px_mm, limits.most_px_mm);
    Vec2 const fixed_mm = camera.to_mm(fixed_px, size);
    return {fixed_mm - (1.0F / scale) * (fixed_px - size.middle_px()), scale};
}

}  // namespace pogosim
