#include <algorithm>

#include "render/layers.hpp"
#include "render/palette.hpp"

namespace pogosim {

namespace {

// In points, see Scene.
constexpr float kSpringWidth = 1.4F;
constexpr float kRodWidth = 2.2F;
constexpr float kHingeRadius = 2.6F;
constexpr float kPinRadius = 1.8F;
constexpr float kEdgeWidth = 0.5F;
constexpr float kThinnestPx = 1.0F;

Pixel mixed(Pixel from, Pixel to, float share) {
    Pixel colour = 0xFF000000U;
    for (unsigned const shift : {0U, 8U, 16U}) {
        auto const a = static_cast<float>(from >> shift & 0xFFU);
        auto const b = static_cast<float>(to >> shift & 0xFFU);
        colour |= static_cast<Pixel>(a + share * (b - a) + 0.5F) << shift;
    }
    return colour;
}

void draw_dot(Scene const& scene, Vec2 centre_mm, float radius, Pixel colour) {
    float const unit = scene.point_px();
    Vec2 const centre = scene.to_pixels(centre_mm);
    scene.canvas.disk(centre, (radius + kEdgeWidth) * unit, scene.colours.edge);
    scene.canvas.disk(centre, radius * unit, colour);
}

void draw_link(Scene const& scene, BodyLink const& link, Vec2 from_mm, Vec2 to_mm) {
    Pixel const colour = tension_colour(scene.colours, link.load);
    if (link.kind == LinkKind::hinge) {
        draw_dot(scene, from_mm, kHingeRadius, colour);
        return;
    }
    float const unit = scene.point_px();
    float const width = std::max((link.kind == LinkKind::rod ? kRodWidth : kSpringWidth) * unit, kThinnestPx);
    Vec2 const from = scene.to_pixels(from_mm);
    Vec2 const to = scene.to_pixels(to_mm);
    scene.canvas.line(from, to, width + 2.0F * kEdgeWidth * unit, Cap::round, scene.colours.edge);
    scene.canvas.line(from, to, width, Cap::round, colour);
    if (link.is_pinned) {
        draw_dot(scene, to_mm, kPinRadius, colour);
    }
}

}  // namespace

Pixel tension_colour(ThemeColours const& colours, float load) {
    float const share = std::clamp(std::abs(load), 0.0F, 1.0F);
    return mixed(colours.link_at_rest, load < 0.0F ? colours.link_pushed : colours.link_pulled, share);
}

void draw_body_links(Scene const& scene) {
    for (BodyLink const& link : scene.snapshot.body_links) {
        Vec2 const span = link.to_mm - link.from_mm;
        float const margin_mm = (kHingeRadius + kEdgeWidth) * scene.point_px() / scene.camera.scale_px_mm;
        Box const box{{std::min(span.x, 0.0F) - margin_mm, std::min(span.y, 0.0F) - margin_mm},
                      {std::max(span.x, 0.0F) + margin_mm, std::max(span.y, 0.0F) + margin_mm}};
        scene.for_each_image(link.from_mm, box, [&](Vec2 from_mm) { draw_link(scene, link, from_mm, from_mm + span); });
    }
}

}  // namespace pogosim
