#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "render/layers.hpp"
#include "render/palette.hpp"

namespace pogosim {

namespace {

// In points, see Scene.
constexpr float kFontSize = 10.5F;
constexpr int kSmallestFontPx = 11;
constexpr float kPad = 5.0F;
constexpr float kMargin = 6.0F;
constexpr float kBarWidth = 2.2F;
constexpr float kPlateOpacity = 0.82F;
constexpr float kSelectionWidth = 1.6F;
constexpr float kSelectionGap = 2.5F;

int font_px(Scene const& scene) {
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
    scene.canvas.polygon(corners, with_opacity(palette::kPaper, kPlateOpacity));
}

bool fits(Scene const& scene, int width, int height) {
    int const margin = whole(2.0F * kMargin * scene.point_px());
    return width + margin <= scene.canvas.size().width_px && height + margin <= scene.canvas.size().height_px;
}

std::string length_text(double length_mm) {
    return length_mm >= 1000.0 ? fmt::format("{:g} m", length_mm / 1000.0) : fmt::format("{:g} mm", length_mm);
}

}  // namespace

double round_length(double longest) {
    double const power = std::pow(10.0, std::floor(std::log10(longest)));
    for (double const step : {5.0, 2.0}) {
        if (step * power <= longest) {
            return step * power;
        }
    }
    return power;
}

void draw_scale_bar(Scene const& scene, Text& text) {
    PictureSize const size = scene.canvas.size();
    double const length_mm = round_length(0.25 * size.width_px / static_cast<double>(scene.camera.scale_px_mm));
    if (!std::isfinite(length_mm)) {
        return;
    }
    float const unit = scene.point_px();
    std::string const label = length_text(length_mm);
    int const font = font_px(scene);
    int const bar = whole(static_cast<float>(length_mm) * scene.camera.scale_px_mm);
    int const label_width = text.width(label, font);
    int const thick = std::max(whole(kBarWidth * unit), 1);
    int const pad = whole(kPad * unit);
    int const gap = whole(2.0F * unit);
    int const width = std::max(bar, label_width) + 2 * pad;
    int const height = thick + gap + font + 2 * pad - gap;
    if (!fits(scene, width, height)) {
        return;
    }
    int const left = whole(kMargin * unit);
    int const top = size.height_px - height - whole(kMargin * unit);
    draw_plate(scene, {left, top, left + width, top + height});
    auto const bar_left = static_cast<float>(left + (width - bar) / 2);
    float const bar_y = static_cast<float>(top + pad) + 0.5F * static_cast<float>(thick);
    scene.canvas.line({bar_left, bar_y}, {bar_left + static_cast<float>(bar), bar_y}, static_cast<float>(thick),
                      Cap::butt, palette::kInk);
    text.draw(scene.canvas, label, font, left + (width - label_width) / 2, top + pad + thick + gap, palette::kInk);
}

void draw_time(Scene const& scene, Text& text) {
    float const unit = scene.point_px();
    std::string const label = fmt::format("t = {:.2f} s", scene.snapshot.time_s);
    int const font = font_px(scene);
    int const pad = whole(kPad * unit);
    int const pad_above = whole(0.5F * kPad * unit);
    int const width = text.width(label, font) + 2 * pad;
    int const height = font + 2 * pad_above;
    if (!fits(scene, width, height)) {
        return;
    }
    int const left = scene.canvas.size().width_px - width - whole(kMargin * unit);
    int const top = whole(kMargin * unit);
    draw_plate(scene, {left, top, left + width, top + height});
    text.draw(scene.canvas, label, font, left + pad, top + pad_above, palette::kInk);
}

void draw_selection(Scene const& scene, std::uint32_t robot, Coverage& scratch) {
    Scenery const& scenery = scene.scenery();
    if (robot >= scenery.robot_body.size()) {
        return;
    }
    float const width = kSelectionWidth * scene.point_px();
    std::uint32_t const body = scenery.robot_body[robot];
    auto const outline = std::find_if(scenery.outlines.begin(), scenery.outlines.end(),
                                      [&](Outline const& own) { return own.robot == robot; });
    if (outline == scenery.outlines.end()) {
        if (body == kNone) {
            return;
        }
        float const radius_mm = scenery.body_radius_mm[body];
        float const radius = scene.to_pixels(radius_mm) + kSelectionGap * scene.point_px();
        scene.for_each_image(scene.snapshot.position_mm[body], radius_mm, [&](Vec2 at_mm) {
            Vec2 const centre = scene.to_pixels(at_mm);
            scene.canvas.ring(centre, radius + width, 1.6F * width, palette::kSelectionRim);
            scene.canvas.ring(centre, radius, width, palette::kSelection);
        });
        return;
    }
    std::vector<Polygon> polygons = outline->polygons;
    if (polygons.empty()) {
        Polygon ring;
        for (std::uint32_t k = 0; k < outline->body_count; ++k) {
            Vec2 const here = scene.snapshot.position_mm[outline->body + k];
            ring.push_back(ring.empty() ? here : ring.back() + scene.from_to(ring.back(), here));
        }
        polygons.push_back(ring);
    }
    for (auto const& [share, colour] :
         {std::pair{3.0F, palette::kSelectionRim}, std::pair{1.0F, palette::kSelection}}) {
        scratch.reset(scene.canvas.clip());
        for (Polygon const& polygon : polygons) {
            add_outline(scratch, scene.to_pixels(polygon), share * width);
        }
        scene.canvas.cover(scratch, colour);
    }
}

}  // namespace pogosim
