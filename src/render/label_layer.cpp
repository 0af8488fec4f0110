#include <algorithm>
#include <string>

#include "render/layers.hpp"
#include "render/plate.hpp"

namespace pogosim {

namespace {

constexpr float kSizeInBody = 1.0F;  // of the font: share of the radius
constexpr float kLeastFontPx = 9.0F;
constexpr float kLargestFontPx = 60.0F;

}  // namespace

void draw_labels(Scene const& scene, Text& text) {
    Scenery const& scenery = scene.scenery();
    for (Object const& object : scenery.objects) {
        if (object.robot == kNone || object.body == kNone || object.body_count != 1) {
            continue;  // no robot, or a wall or membrane with a program
        }
        std::uint32_t const body = object.body;
        float const radius_mm = scenery.body_radius_mm[body];
        float const radius_px = scene.to_pixels(radius_mm);
        int const font = whole(std::clamp(kSizeInBody * radius_px, kLeastFontPx, kLargestFontPx));
        std::string const label = std::to_string(scenery.robot_id[object.robot]);
        int const width = text.width(label, font);
        bool const is_inside = static_cast<float>(width) < 1.8F * radius_px;
        Pixel const below = is_inside ? body_colour(scene, object.robot) : scene.colours.floor;
        scene.for_each_image(scene.snapshot.position_mm[body], radius_mm, [&](Vec2 at_mm) {
            Vec2 const centre = scene.to_pixels(at_mm);
            int const left = whole(centre.x) + (is_inside ? -width / 2 : whole(radius_px) + 1);
            int const top = whole(centre.y) - font / 2;
            text.draw(scene.canvas, label, font, left, top, scene.colours.of_text_on(below));
        });
    }
}

}  // namespace pogosim
