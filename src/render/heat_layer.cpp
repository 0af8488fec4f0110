#include "render/heat_layer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/between.hpp"
#include "render/blend.hpp"

namespace pogosim {

namespace {

constexpr float kOpacity = 0.85F;
constexpr float kFaintShare = 0.12F;  // of the range: a density below fades into the floor

/// The least round number that is not below.
float round_up(float value) {
    double const power = std::pow(10.0, std::floor(std::log10(static_cast<double>(value))));
    for (double const step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
        if (step * power >= static_cast<double>(value) * (1.0 - 1e-6)) {
            return static_cast<float>(step * power);
        }
    }
    return static_cast<float>(10.0 * power);
}

void draw_field(Scene const& scene, HeatField const& field, ValueScale const& scale, bool fades) {
    PictureSize const size = scene.canvas.size();
    PixelBox const clip = intersection(scene.canvas.clip(), scene.floor.box());
    std::vector<Between> columns;
    for (int x = clip.left; x < clip.right; ++x) {
        float const mm = scene.camera.to_mm({static_cast<float>(x) + 0.5F, 0.0F}, size).x;
        columns.push_back(between((mm - field.origin_mm.x) / field.cell_mm, field.columns));
    }
    auto const width = static_cast<std::size_t>(field.columns);
    for (int y = clip.top; y < clip.bottom; ++y) {
        float const mm = scene.camera.to_mm({0.0F, static_cast<float>(y) + 0.5F}, size).y;
        Between const row = between((mm - field.origin_mm.y) / field.cell_mm, field.rows);
        std::uint8_t const* const floor = scene.floor.row(y) + (clip.left - scene.floor.box().left);
        Pixel* const pixels = scene.canvas.pixels().data() + static_cast<std::ptrdiff_t>(y) * size.width_px + clip.left;
        for (std::size_t x = 0; x < columns.size(); ++x) {
            if (floor[x] == 0) {
                continue;
            }
            Between const& column = columns[x];
            auto const at = [&](std::vector<float> const& values) {
                float const* const above = values.data() + row.low * width;
                float const* const below = values.data() + row.high * width;
                float const left = std::lerp(above[column.low], below[column.low], row.share);
                float const right = std::lerp(above[column.high], below[column.high], row.share);
                return std::lerp(left, right, column.share);
            };
            float const share = scale.share(at(field.value));
            float const fading = fades ? std::min(share / kFaintShare, 1.0F) : 1.0F;
            float const opacity = kOpacity * fading * at(field.certainty);
            blend(pixels[x], scale.colour(scene.colours, share), opacity * static_cast<float>(floor[x]),
                  256.0F / 255.0F);
        }
    }
}

}  // namespace

bool HeatLayer::is_up_to_date(Snapshot const& snapshot) const {
    bool const is_density = !snapshot.heat_map;
    return scenery_ == snapshot.scenery && position_mm_ == snapshot.position_mm && is_density == is_density_ &&
           (is_density || (values_ == snapshot.heat_map->values && is_angle_ == snapshot.heat_map->is_angle));
}

void HeatLayer::update(Snapshot const& snapshot) {
    if (is_up_to_date(snapshot)) {
        return;
    }
    scenery_ = snapshot.scenery;
    position_mm_ = snapshot.position_mm;
    is_density_ = !snapshot.heat_map;
    if (is_density_) {
        field_ = density_field(snapshot);
        return;
    }
    values_ = snapshot.heat_map->values;
    is_angle_ = snapshot.heat_map->is_angle;
    field_ = (is_angle_ ? mean_angle_field : mean_field)(snapshot, values_);
}

ColourKey HeatLayer::draw(Scene const& scene) {
    Snapshot const& snapshot = scene.snapshot;
    update(snapshot);
    if (snapshot.heat_map) {
        ColourKey key = key_of(*snapshot.heat_map);
        draw_field(scene, field_, key.scale, false);
        return key;
    }
    float const most = *std::ranges::max_element(field_.value);
    ColourKey key{.name = "robots per m2", .scale = {.low = 0.0F, .high = most > 0.0F ? round_up(most) : 1.0F}};
    draw_field(scene, field_, key.scale, true);
    return key;
}

}  // namespace pogosim
