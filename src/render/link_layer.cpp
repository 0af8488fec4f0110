#include <algorithm>
#include <array>
#include <bit>

#include "render/layers.hpp"
#include "render/palette.hpp"

namespace pogosim {

namespace {

constexpr float kWidth = 1.5F;  // points, see Scene
constexpr float kThinnestPx = 1.2F;
constexpr float kOneWayWidth = 0.75F;  // share
constexpr float kOpacity = 0.9F;
constexpr std::array kFading{0.6F, 0.45F, 0.3F};  // opacity of the pieces of the far half
constexpr float kHeadLength = 4.2F;               // in widths of the line
constexpr float kHeadHalfWidth = 2.0F;

Pixel colour_of(Scene const& scene, std::uint8_t emitters) {
    return emitters == kAllFaces
               ? scene.colours.link_by_all_emitters
               : scene.colours.link_by_emitter[static_cast<std::size_t>(std::countr_zero(emitters)) % kMostFaces];
}

void draw_two_way(Scene const& scene, Vec2 from, Vec2 to, InfraredLink const& link, float width) {
    Vec2 const middle = 0.5F * (from + to);
    scene.canvas.chain_link(from, middle, width, with_opacity(colour_of(scene, link.emitters), kOpacity));
    scene.canvas.chain_link(middle, to, width, with_opacity(colour_of(scene, link.emitters_back), kOpacity));
}

void draw_one_way(Scene const& scene, Vec2 from, Vec2 to, InfraredLink const& link, float width) {
    Pixel const colour = colour_of(scene, link.emitters);
    float const size = length(to - from);
    if (size < 1e-3F) {
        return;
    }
    Vec2 const along = (1.0F / size) * (to - from);
    float const head = std::min(kHeadLength * width, 0.45F * size);
    float const half_head = head * kHeadHalfWidth / kHeadLength;
    Vec2 const foot = to - head * along;
    Vec2 const middle = 0.5F * (from + to);
    float const line_width = kOneWayWidth * width;
    scene.canvas.chain_link(from, middle, line_width, with_opacity(colour, kOpacity));
    Vec2 const piece = (1.0F / static_cast<float>(kFading.size())) * (foot - middle);
    for (std::size_t i = 0; i < kFading.size(); ++i) {
        Vec2 const start = middle + static_cast<float>(i) * piece;
        scene.canvas.chain_link(start, start + piece, line_width, with_opacity(colour, kFading[i]));
    }
    Vec2 const beside{-along.y, along.x};
    std::array const corners{to, foot + half_head * beside, foot - half_head * beside};
    scene.canvas.polygon(corners, with_opacity(colour, kOpacity));
}

}  // namespace

void draw_links(Scene const& scene) {
    float const width = std::max(kWidth * scene.point_px(), kThinnestPx);
    for (InfraredLink const& link : scene.snapshot.links) {
        Vec2 const span = link.to_mm - link.from_mm;
        Box const box{{std::min(span.x, 0.0F), std::min(span.y, 0.0F)},
                      {std::max(span.x, 0.0F), std::max(span.y, 0.0F)}};
        scene.for_each_image(link.from_mm, box, [&](Vec2 from_mm) {
            Vec2 const from = scene.to_pixels(from_mm);
            Vec2 const to = scene.to_pixels(from_mm + span);
            if (link.emitters_back != 0) {
                draw_two_way(scene, from, to, link, width);
            } else {
                draw_one_way(scene, from, to, link, width);
            }
        });
    }
}

}  // namespace pogosim
