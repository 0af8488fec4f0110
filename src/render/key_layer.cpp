#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "render/colour_key.hpp"
#include "render/plate.hpp"

namespace pogosim {

namespace {

// In points, see Scene.
constexpr float kBarLength = 110.0F;
constexpr float kBarWidth = 7.0F;
constexpr float kGap = 2.0F;

std::string number_text(float value) {
    return fmt::format("{:.4g}", std::abs(value) < 1e-30F ? 0.0F : value);
}

/// What stands below both ends of a bar of colours.
std::pair<std::string, std::string> ends_of(ValueScale const& scale) {
    if (scale.is_angle) {
        return {"-pi", "pi"};
    }
    return std::isnan(scale.low) ? std::pair<std::string, std::string>("no values", "")
                                 : std::pair(number_text(scale.low), number_text(scale.high));
}

/// Draws a key with its lower edge at `bottom`; returns its upper edge.
int draw_key(Scene const& scene, Text& text, ColourKey const& key, int bottom) {
    float const unit = scene.point_px();
    int const font = note_font_px(scene);
    int const pad = whole(kNotePad * unit);
    int const gap = whole(kGap * unit);
    int const thick = std::max(whole(kBarWidth * unit), 2);
    auto const [low, high] = ends_of(key.scale);
    int const numbers = text.width(low, font) + text.width(high, font) + 3 * gap;
    int const bar = std::max({whole(kBarLength * unit), text.width(key.name, font), numbers});
    int const width = bar + 2 * pad;
    int const height = 2 * font + thick + 2 * gap + pad;
    if (!plate_fits(scene, width, height)) {
        return bottom;
    }
    int const left = scene.canvas.size().width_px - width - whole(kNoteMargin * unit);
    int const top = bottom - height;
    draw_plate(scene, {left, top, left + width, bottom});
    Pixel const ink = scene.colours.ink;
    text.draw(scene.canvas, key.name, font, left + pad, top + pad / 2, ink);
    int const bar_top = top + pad / 2 + font + gap;
    for (int x = 0; x < bar; ++x) {
        float const share = (static_cast<float>(x) + 0.5F) / static_cast<float>(bar);
        auto const at = static_cast<float>(left + pad + x);
        Vec2 const corners[4] = {{at, static_cast<float>(bar_top)},
                                 {at + 1.0F, static_cast<float>(bar_top)},
                                 {at + 1.0F, static_cast<float>(bar_top + thick)},
                                 {at, static_cast<float>(bar_top + thick)}};
        scene.canvas.polygon(corners, key.scale.colour(scene.colours, share));
    }
    int const line = bar_top + thick + gap;
    text.draw(scene.canvas, low, font, left + pad, line, ink);
    text.draw(scene.canvas, high, font, left + pad + bar - text.width(high, font), line, ink);
    return top;
}

}  // namespace

float ValueScale::share(float value) const {
    return high > low ? std::clamp((value - low) / (high - low), 0.0F, 1.0F) : 0.5F;
}

Pixel ValueScale::colour(ThemeColours const& colours, float share) const {
    return is_angle ? colours.of_angle(std::lerp(low, high, share)) : ThemeColours::of_share(share);
}

ValueScale scale_of(RobotColumn const& column) {
    constexpr float kHalfTurn = std::numbers::pi_v<float>;
    return column.is_angle ? ValueScale{.low = -kHalfTurn, .high = kHalfTurn, .is_angle = true}
                           : ValueScale{.low = column.low, .high = column.high};
}

ColourKey key_of(RobotColumn const& column) {
    return {.name = column.unit.empty() ? column.name : fmt::format("{} ({})", column.name, column.unit),
            .scale = scale_of(column)};
}

void draw_keys(Scene const& scene, Text& text, std::span<ColourKey const> keys) {
    int bottom = scene.canvas.size().height_px - whole(kNoteMargin * scene.point_px());
    for (ColourKey const& key : keys) {
        bottom = draw_key(scene, text, key, bottom) - whole(kGap * scene.point_px());
    }
}

}  // namespace pogosim
