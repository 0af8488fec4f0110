#include "render/painter.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include "render/background.hpp"
#include "render/heat_layer.hpp"
#include "render/layers.hpp"
#include "render/text.hpp"
#include "render/theme_colours.hpp"

namespace pogosim {

namespace {

/// The trails as they were drawn last: most of the work of a picture. They stay while a snapshot has the same ones.
class TrailLayer {
public:
    void draw(Scene const& scene) {
        if (is_as_before(scene)) {
            scene.canvas.lay_over(layer_);
            return;
        }
        trails_ = scene.snapshot.trails;
        camera_ = scene.camera;
        colours_ = scene.colours;
        clip_ = scene.canvas.clip();
        if (layer_.size() != scene.canvas.size()) {
            layer_.resize(scene.canvas.size());
        }
        layer_.clear();
        layer_.clip_to(clip_);
        draw_trails({layer_, scene.camera, scene.snapshot, scene.floor, scene.colours});
        scene.canvas.lay_over(layer_);
    }

private:
    bool is_as_before(Scene const& scene) const {
        return trails_ == scene.snapshot.trails && camera_ == scene.camera && colours_ == scene.colours &&
               clip_ == scene.canvas.clip() && layer_.size() == scene.canvas.size();
    }

    std::shared_ptr<Trails const> trails_;
    Camera camera_;
    ThemeColours colours_;
    PixelBox clip_;
    Canvas layer_{{0, 0}};
};

}  // namespace

struct Painter::Impl {
    Background background;
    HeatLayer heat_map;
    TrailLayer trails;
    Text text;
    Coverage scratch;
};

Painter::Painter() : impl_(std::make_unique<Impl>()) {}
Painter::~Painter() = default;

SnapshotParts parts_for(ViewOptions const& options) {
    return {.light = options.light_levels,
            .links = options.links != LinkLayer::hidden,
            .trails = options.trails,
            .velocities = options.velocities,
            .heard = options.heard,
            .color_by = options.color_by,
            .heat_map = options.heat_map == kDensity ? "" : options.heat_map};
}

Camera camera_for(ViewOptions const& options, Snapshot const& snapshot, PictureSize size) {
    Scenery const& scenery = *snapshot.scenery;
    Camera camera = fitted(scenery.arena.bounds, size);
    camera.scale_px_mm *= static_cast<float>(options.zoom);
    if (options.follow) {
        auto const robot = std::ranges::find(scenery.robot_id, *options.follow) - scenery.robot_id.begin();
        if (robot < std::ssize(scenery.robot_id)) {
            std::uint32_t const body = scenery.robot_body[static_cast<std::size_t>(robot)];
            camera.centre_mm = body == kNone ? camera.centre_mm : snapshot.position_mm[body];
        }
    }
    return camera;
}

void Painter::paint(Canvas& canvas, Camera const& camera, Snapshot const& snapshot, ViewOptions const& options) {
    canvas.clip_to(canvas.bounds());
    ThemeColours const colours = theme_colours(options);
    impl_->background.draw(canvas, camera, snapshot, colours, options.light_levels);
    Scene const scene{canvas, camera, snapshot, impl_->background.floor(), colours};
    std::vector<ColourKey> keys;

    // Objects across a seam are drawn on both sides of it, but not beyond the arena.
    if (snapshot.scenery->periodic) {
        Box const& bounds = snapshot.scenery->arena.bounds;
        Box const seams{scene.to_pixels(bounds.min), scene.to_pixels(bounds.max)};
        canvas.clip_to(pixels_of(seams, canvas.bounds()));
    }
    if (options.heat_map == kDensity || snapshot.heat_map) {
        keys.push_back(impl_->heat_map.draw(scene));
    }
    draw_glows(scene);
    if (options.links == LinkLayer::below) {
        draw_links(scene);
    }
    if (options.trails && snapshot.trails) {
        impl_->trails.draw(scene);
    }
    draw_membranes(scene);
    draw_bodies(scene, options.lateral_leds);
    if (!snapshot.body_links.empty()) {
        draw_body_links(scene);
        draw_headings(scene);
    }
    draw_lamps(scene, impl_->scratch);
    if (options.heard) {
        draw_heard(scene);
    }
    if (options.velocities) {
        draw_velocities(scene);
    }
    if (options.labels) {
        draw_labels(scene, impl_->text);
    }
    if (options.selected_robot) {
        draw_selection(scene, *options.selected_robot, impl_->scratch);
    }
    if (options.links == LinkLayer::above) {
        draw_links(scene);
    }
    canvas.clip_to(canvas.bounds());
    if (options.scale_bar) {
        draw_scale_bar(scene, impl_->text);
    }
    if (snapshot.color_by) {
        keys.push_back(key_of(*snapshot.color_by));
    }
    draw_keys(scene, impl_->text, keys);
    if (options.time) {
        draw_time(scene, impl_->text);
    }
}

}  // namespace pogosim
