// Arrows: where bodies move, and which robots heard which.
#include <algorithm>
#include <array>

#include "render/layers.hpp"

namespace pogosim {

namespace {

// In points, see Scene.
constexpr float kWidth = 1.3F;
constexpr float kThinnestPx = 1.0F;
constexpr float kHeadLength = 4.5F;  // in widths of the line
constexpr float kHeadHalfWidth = 2.2F;
constexpr float kLeastLengthPx = 1.5F;

void draw_arrow(Scene const& scene, Vec2 from, Vec2 to, Pixel colour) {
    Vec2 const span = to - from;
    float const size = length(span);
    if (!(size > kLeastLengthPx)) {
        return;
    }
    float const width = std::max(kWidth * scene.point_px(), kThinnestPx);
    Vec2 const along = (1.0F / size) * span;
    float const head = std::min(kHeadLength * width, 0.6F * size);
    Vec2 const foot = to - head * along;
    Vec2 const beside = (head * kHeadHalfWidth / kHeadLength) * Vec2{-along.y, along.x};
    scene.canvas.line(from, foot, width, Cap::butt, colour);
    std::array const corners{to, foot + beside, foot - beside};
    scene.canvas.polygon(corners, colour);
}

Box box_of(Vec2 span) {
    return {{std::min(span.x, 0.0F), std::min(span.y, 0.0F)}, {std::max(span.x, 0.0F), std::max(span.y, 0.0F)}};
}

void draw_arrow_mm(Scene const& scene, Vec2 from_mm, Vec2 span_mm, Pixel colour) {
    scene.for_each_image(from_mm, box_of(span_mm), [&](Vec2 at_mm) {
        draw_arrow(scene, scene.to_pixels(at_mm), scene.to_pixels(at_mm + span_mm), colour);
    });
}

}  // namespace

void draw_velocities(Scene const& scene) {
    Snapshot const& snapshot = scene.snapshot;
    Pixel const colour = scene.colours.contrast_to(scene.colours.floor);
    for (Object const& object : scene.scenery().objects) {
        if (object.body != kNone && object.body_count == 1 && object.body < snapshot.velocity_mm_s.size()) {
            draw_arrow_mm(scene, snapshot.position_mm[object.body], snapshot.velocity_mm_s[object.body], colour);
        }
    }
}

void draw_heard(Scene const& scene) {
    Scenery const& scenery = scene.scenery();
    Pixel const colour = scene.colours.heard;
    for (HeardMessage const& heard : scene.snapshot.heard) {
        std::uint32_t const from = scenery.robot_body[heard.sender];
        std::uint32_t const to = scenery.robot_body[heard.receiver];
        if (from == kNone || to == kNone) {
            continue;
        }
        Vec2 const start_mm = scene.snapshot.position_mm[from];
        Vec2 const span_mm = scene.from_to(start_mm, scene.snapshot.position_mm[to]);
        float const size_mm = length(span_mm);
        float const gap_mm = scenery.body_radius_mm[from] + scenery.body_radius_mm[to];
        if (size_mm <= gap_mm) {
            continue;  // they touch: there is no room for an arrow
        }
        Vec2 const along = (1.0F / size_mm) * span_mm;
        auto const age_s = static_cast<float>(scene.snapshot.time_s - heard.time_s);
        float const freshness = std::clamp(1.0F - age_s / kHeardForS, 0.0F, 1.0F);
        draw_arrow_mm(scene, start_mm + scenery.body_radius_mm[from] * along, (size_mm - gap_mm) * along,
                      with_opacity(colour, 0.15F + 0.75F * freshness));
    }
}

}  // namespace pogosim
