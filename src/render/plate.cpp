#include "render/plate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pogosim {

namespace {

constexpr float kFontSize = 10.5F;  // points
constexpr int kSmallestFontPx = 11;
constexpr float kPlateOpacity = 0.82F;

}  // namespace

int note_font_px(Scene const& scene) {
    return std::max(static_cast<int>(std::lround(kFontSize * scene.point_px())), kSmallestFontPx);
}

int whole(float value) {
    return static_cast<int>(std::lround(value));
}

/// A rectangle with round corners on which text is legible, whatever is below.
void draw_plate(Scene const& scene, PixelBox const& box) {
    float const radius = 3.0F * scene.point_px();
    auto const left = static_cast<float>(box.left);
    auto const top = static_cast<float>(box.top);
    auto const right = static_cast<float>(box.right);
    auto const bottom = static_cast<float>(box.bottom);
    Vec2 const centres[4] = {{right - radius, bottom - radius},
                             {left + radius, bottom - radius},
                             {left + radius, top + radius},
                             {right - radius, top + radius}};
    Polygon corners;
    constexpr int kSteps = 6;
    for (int corner = 0; corner < 4; ++corner) {
        for (int i = 0; i <= kSteps; ++i) {
            float const quarters = static_cast<float>(corner) + static_cast<float>(i) / kSteps;
            corners.push_back(centres[corner] + radius * direction(0.5F * std::numbers::pi_v<float> * quarters));
        }
    }
    scene.canvas.polygon(corners, with_opacity(scene.colours.paper, kPlateOpacity));
}

bool plate_fits(Scene const& scene, int width, int height) {
    int const margin = whole(2.0F * kNoteMargin * scene.point_px());
    return width + margin <= scene.canvas.size().width_px && height + margin <= scene.canvas.size().height_px;
}

}  // namespace pogosim
