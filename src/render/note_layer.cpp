#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "render/layers.hpp"
#include "render/plate.hpp"

namespace pogosim {

namespace {

// In points, see Scene.
constexpr float kBarWidth = 2.2F;
constexpr float kSelectionWidth = 1.6F;
constexpr float kSelectionGap = 2.5F;

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
    int const font = note_font_px(scene);
    int const bar = whole(static_cast<float>(length_mm) * scene.camera.scale_px_mm);
    int const label_width = text.width(label, font);
    int const thick = std::max(whole(kBarWidth * unit), 1);
    int const pad = whole(kNotePad * unit);
    int const gap = whole(2.0F * unit);
    int const width = std::max(bar, label_width) + 2 * pad;
    int const height = thick + gap + font + 2 * pad - gap;
    if (!plate_fits(scene, width, height)) {
        return;
    }
    int const left = whole(kNoteMargin * unit);
    int const top = size.height_px - height - whole(kNoteMargin * unit);
    draw_plate(scene, {left, top, left + width, top + height});
    auto const bar_left = static_cast<float>(left + (width - bar) / 2);
    float const bar_y = static_cast<float>(top + pad) + 0.5F * static_cast<float>(thick);
    scene.canvas.line({bar_left, bar_y}, {bar_left + static_cast<float>(bar), bar_y}, static_cast<float>(thick),
                      Cap::butt, scene.colours.ink);
    text.draw(scene.canvas, label, font, left + (width - label_width) / 2, top + pad + thick + gap, scene.colours.ink);
}

void draw_time(Scene const& scene, Text& text) {
    float const unit = scene.point_px();
    std::string const label = fmt::format("t = {:.2f} s", scene.snapshot.time_s);
    int const font = note_font_px(scene);
    int const pad = whole(kNotePad * unit);
    int const pad_above = whole(0.5F * kNotePad * unit);
    int const width = text.width(label, font) + 2 * pad;
    int const height = font + 2 * pad_above;
    if (!plate_fits(scene, width, height)) {
        return;
    }
    int const left = scene.canvas.size().width_px - width - whole(kNoteMargin * unit);
    int const top = whole(kNoteMargin * unit);
    draw_plate(scene, {left, top, left + width, top + height});
    text.draw(scene.canvas, label, font, left + pad, top + pad_above, scene.colours.ink);
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
            scene.canvas.ring(centre, radius + width, 1.6F * width, scene.colours.selection_rim);
            scene.canvas.ring(centre, radius, width, scene.colours.selection);
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
         {std::pair{3.0F, scene.colours.selection_rim}, std::pair{1.0F, scene.colours.selection}}) {
        scratch.reset(scene.canvas.clip());
        for (Polygon const& polygon : polygons) {
            add_outline(scratch, scene.to_pixels(polygon), share * width);
        }
        scene.canvas.cover(scratch, colour);
    }
}

}  // namespace pogosim
