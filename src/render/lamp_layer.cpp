#include <cmath>
#include <numbers>

#include "render/layers.hpp"
#include "render/palette.hpp"

namespace pogosim {

namespace {

// In points, see Scene.
constexpr float kSunRadius = 3.0F;
constexpr float kRayFrom = 4.5F;
constexpr float kRayTo = 6.8F;
constexpr float kRayWidth = 1.1F;
constexpr int kRays = 8;
constexpr float kOutlineWidth = 0.7F;
constexpr float kBeamWidth = 1.6F;
constexpr float kBeamOpacity = 0.55F;

void draw_sun(Scene const& scene, Vec2 centre_px) {
    float const unit = scene.point_px();
    scene.canvas.disk(centre_px, (kSunRadius + 0.8F) * unit, scene.colours.edge);
    scene.canvas.disk(centre_px, kSunRadius * unit, scene.colours.lamp);
    for (int i = 0; i < kRays; ++i) {
        Vec2 const outwards = direction(2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kRays);
        scene.canvas.line(centre_px + kRayFrom * unit * outwards, centre_px + kRayTo * unit * outwards,
                          kRayWidth * unit, Cap::round, scene.colours.lamp);
    }
}

}  // namespace

void draw_lamps(Scene const& scene, Coverage& scratch) {
    std::vector<LampMark> const& lamps = scene.snapshot.lamps;
    if (lamps.empty()) {
        return;
    }
    float const unit = scene.point_px();
    scratch.reset(scene.canvas.clip());
    for (LampMark const& lamp : lamps) {
        if (!is_everywhere(lamp.shape)) {
            scene.for_each_image(lamp.shape_mm, bounding_box(lamp.shape), [&](Vec2 where_mm) {
                add_outline(scratch, scene.to_pixels(moved(outline(lamp.shape), where_mm, 0.0F)), kOutlineWidth * unit);
            });
        }
    }
    scratch.keep_within(scene.floor);
    scene.canvas.cover(scratch, scene.colours.lamp_outline);

    scratch.reset(scene.canvas.clip());
    float const across_mm = length(scene.scenery().arena.bounds.size());
    for (LampMark const& lamp : lamps) {
        if (lamp.has_beam && lamp.beam_is_on) {
            Vec2 const end = lamp.centre_mm + across_mm * direction(lamp.beam_rad);
            scratch.add_line(scene.to_pixels(lamp.centre_mm), scene.to_pixels(end), kBeamWidth * unit);
        }
    }
    scratch.keep_within(scene.floor);
    scene.canvas.cover(scratch, with_opacity(scene.colours.lamp, kBeamOpacity));

    for (LampMark const& lamp : lamps) {
        draw_sun(scene, scene.to_pixels(lamp.centre_mm));
    }
}

}  // namespace pogosim
