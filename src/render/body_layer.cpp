#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/layers.hpp"
#include "render/led_colour.hpp"

namespace pogosim {

namespace {

constexpr float kEdge = 0.07F;  // of all widths here: share of the object's size
constexpr float kThinnestEdgePx = 0.7F;
constexpr float kLeastEdgedRadiusPx = 2.0F;
constexpr float kMark = 0.125F;
constexpr float kThinnestMarkPx = 1.0F;
constexpr float kGlowReach = 0.9F;  // beyond the rim
constexpr float kGlowOpacity = 0.55F;
constexpr float kLateralLed = 0.3F;
constexpr int kCornersOfATurn = 64;
constexpr float kLineOpacity = 0.45F;  // of the line through a membrane

/// Pose and look of one rigid object.
struct Figure {
    Shape shape;
    float radius_mm;  // of the bounding disk
    Vec2 position_mm;
    Vec2 axis;  // unit vector along the heading
    bool has_axis;
    Pixel colour;
    bool glows;
    Leds const* led;  // null: it runs no program
    std::vector<Part> const* led_parts;
    bool leds_turned;
};

/// Those that `rotate_LEDs_45_deg` turns: a model with LEDs of its own says where they are.
bool are_usual(std::vector<Part> const& leds) {
    static std::vector<Part> const usual = head_and_four_leds();
    return leds == usual;
}

/// The colour of an object that runs no program.
Pixel colour_without_leds(Scene const& scene, Object const& object) {
    std::vector<Rgb> const& shown = scene.snapshot.shown_rgb;
    auto const index = static_cast<std::size_t>(&object - scene.scenery().objects.data());
    return shown.empty() ? scene.colours.no_led : opaque(shown[index]);
}

Figure figure_of(Scene const& scene, Object const& object) {
    Scenery const& scenery = scene.scenery();
    Snapshot const& snapshot = scene.snapshot;
    float const heading = snapshot.heading_rad[object.body];
    bool const has_axis = std::isfinite(heading);
    Figure figure{
        .shape = scenery.body_shape[object.body],
        .radius_mm = scenery.body_radius_mm[object.body],
        .position_mm = snapshot.position_mm[object.body],
        .axis = has_axis ? direction(heading) : Vec2{1.0F, 0.0F},
        .has_axis = has_axis,
        .colour = scene.colours.no_led,
        .glows = false,
        .led = nullptr,
        .led_parts = nullptr,
        .leds_turned = false,
    };
    if (object.robot != kNone) {
        figure.led = &snapshot.led[object.robot];
        figure.colour = body_colour(scene, object.robot);
        figure.glows = !snapshot.color_by && snapshot.shown_rgb.empty() && is_lit((*figure.led)[0]);
        auto const& spec = scenery.categories[object.category].spec.robot;
        figure.led_parts = &spec->model.leds;
        figure.leds_turned = spec->rotate_leds_45_deg && are_usual(spec->model.leds);
    } else {
        figure.colour = colour_without_leds(scene, object);
    }
    return figure;
}

/// A shape with every side moved outwards by some pixels.
void draw_shape(Scene const& scene, Figure const& figure, Vec2 at_mm, float outwards_px, Pixel colour) {
    Vec2 const centre = scene.to_pixels(at_mm);
    if (figure.shape.kind == ShapeKind::disk) {
        scene.canvas.disk(centre, scene.to_pixels(figure.shape.radius_mm) + outwards_px, colour);
        return;
    }
    for (Polygon& corners : outlines(inset(figure.shape, -outwards_px / scene.camera.scale_px_mm), kCornersOfATurn)) {
        for (Vec2& corner : corners) {
            corner = centre + scene.camera.scale_px_mm * rotate(corner, figure.axis);
        }
        scene.canvas.polygon(corners, colour);
    }
}

void draw_glow(Scene const& scene, Figure const& figure) {
    float const glow_mm = figure.radius_mm + kGlowReach * inner_radius(figure.shape);
    scene.for_each_image(figure.position_mm, glow_mm, [&](Vec2 at_mm) {
        scene.canvas.glow(scene.to_pixels(at_mm), scene.to_pixels(glow_mm), with_opacity(figure.colour, kGlowOpacity),
                          scene.floor);
    });
}

void draw_lateral_leds(Scene const& scene, Figure const& figure, Vec2 at_mm, float edge_px) {
    float const radius_px = kLateralLed * scene.to_pixels(inner_radius(figure.shape));
    for (std::size_t k = 1; k < figure.led_parts->size(); ++k) {
        Rgb const led = (*figure.led)[k];
        Part const& part = (*figure.led_parts)[k];
        if (!is_lit(led)) {
            continue;
        }
        if (!part.is_on_rim()) {
            Vec2 const centre = scene.to_pixels(at_mm + rotate(part.place.at_mm(figure.radius_mm), figure.axis));
            scene.canvas.disk(centre, radius_px + edge_px, scene.colours.edge);
            scene.canvas.disk(centre, radius_px, scene.colours.of_led(led));
            continue;
        }
        static Vec2 const eighth_of_a_turn = direction(0.25F * std::numbers::pi_v<float>);
        Vec2 const side = figure.leds_turned ? rotate(part.direction, eighth_of_a_turn) : part.direction;
        Vec2 const outwards = rotate(side, figure.axis);
        Vec2 const centre = scene.to_pixels(at_mm + reach(figure.shape, side) * outwards);
        scene.canvas.half_disk(centre, radius_px + edge_px, -outwards, scene.colours.edge);
        scene.canvas.half_disk(centre, radius_px, -outwards, scene.colours.of_led(led));
    }
}

/// Width of the edge, pixels; 0: it is too small for one.
float edge_of(Scene const& scene, Figure const& figure) {
    float const size_px = scene.to_pixels(inner_radius(figure.shape));
    return size_px < kLeastEdgedRadiusPx ? 0.0F : std::max(kEdge * size_px, kThinnestEdgePx);
}

/// A mark where it heads.
void draw_mark(Scene const& scene, Figure const& figure, Vec2 at_mm) {
    if (figure.has_axis && edge_of(scene, figure) > 0.0F) {
        float const size_px = scene.to_pixels(inner_radius(figure.shape));
        float const ahead_mm = reach(figure.shape, {1.0F, 0.0F});
        scene.canvas.line(scene.to_pixels(at_mm + 0.25F * ahead_mm * figure.axis),
                          scene.to_pixels(at_mm + 0.95F * ahead_mm * figure.axis),
                          std::max(kMark * size_px, kThinnestMarkPx), Cap::butt,
                          scene.colours.contrast_to(figure.colour));
    }
}

void draw_figure(Scene const& scene, Figure const& figure, bool lateral_leds) {
    scene.for_each_image(figure.position_mm, figure.radius_mm, [&](Vec2 at_mm) {
        float const edge_px = edge_of(scene, figure);
        if (edge_px > 0.0F) {
            draw_shape(scene, figure, at_mm, 0.5F * edge_px, scene.colours.edge);
        }
        draw_shape(scene, figure, at_mm, -0.5F * edge_px, figure.colour);
        draw_mark(scene, figure, at_mm);
        if (lateral_leds && figure.led != nullptr) {
            draw_lateral_leds(scene, figure, at_mm, 0.5F * edge_px);
        }
    });
}

/// The bodies of a membrane one after the other, from the first, wherever seams are.
Polygon unrolled(Scene const& scene, Object const& object) {
    std::vector<Vec2> const& position = scene.snapshot.position_mm;
    Polygon centres{position[object.body]};
    for (std::uint32_t k = 1; k < object.body_count; ++k) {
        centres.push_back(centres.back() + scene.from_to(centres.back(), position[object.body + k]));
    }
    return centres;
}

void draw_membrane(Scene const& scene, Object const& object, Coverage& scratch) {
    MembraneSpec const& membrane = *scene.scenery().categories[object.category].spec.membrane;
    float const half_mm =
        membrane.segments ? 0.5F * membrane.thickness_mm.value_or(membrane.radius_mm) : membrane.radius_mm;
    float const dot_mm = half_mm * (membrane.segments ? 0.35F : 1.0F);
    float const line_mm = 2.0F * half_mm / (membrane.segments ? 1.0F : 3.0F);
    Pixel const colour = object.robot == kNone ? colour_without_leds(scene, object) : body_colour(scene, object.robot);
    Polygon const centres = unrolled(scene, object);
    Box around = bounding_box(centres);
    around.min = around.min - Vec2{half_mm, half_mm};
    around.max = around.max + Vec2{half_mm, half_mm};
    scene.for_each_image({}, around, [&](Vec2 offset_mm) {
        Polygon corners(centres.size());
        std::transform(centres.begin(), centres.end(), corners.begin(),
                       [&](Vec2 centre) { return scene.to_pixels(centre + offset_mm); });
        Box const box{scene.to_pixels(around.min + offset_mm), scene.to_pixels(around.max + offset_mm)};
        scratch.reset(pixels_of(box, scene.canvas.clip()));
        add_outline(scratch, corners, std::max(scene.to_pixels(line_mm), 1.0F));
        scene.canvas.cover(scratch, with_opacity(colour, kLineOpacity));
        float const radius_px = scene.to_pixels(dot_mm);
        float const edge_px = radius_px < kLeastEdgedRadiusPx ? 0.0F : std::max(kEdge * radius_px, kThinnestEdgePx);
        for (Vec2 const corner : corners) {
            if (edge_px > 0.0F) {
                scene.canvas.disk(corner, radius_px + 0.5F * edge_px, scene.colours.edge);
            }
            scene.canvas.disk(corner, radius_px - 0.5F * edge_px, colour);
        }
    });
}

template <class Draw>
void for_each_rigid_object(Scene const& scene, Draw const& draw) {
    for (Object const& object : scene.scenery().objects) {
        if (object.body != kNone && object.body_count == 1) {
            draw(object);
        }
    }
}

}  // namespace

Pixel body_colour(Scene const& scene, std::uint32_t robot) {
    if (!scene.snapshot.color_by) {
        return shown_colour(scene.snapshot, scene.colours, scene.snapshot.led[robot][0], scene.colours.dark_led);
    }
    RobotColumn const& column = *scene.snapshot.color_by;
    float const value = column.values[robot];
    ValueScale const scale = scale_of(column);
    return std::isfinite(value) ? scale.colour(scene.colours, scale.share(value)) : scene.colours.no_led;
}

void draw_membranes(Scene const& scene) {
    Coverage scratch;
    for (Object const& object : scene.scenery().objects) {
        if (object.body_count > 1) {
            draw_membrane(scene, object, scratch);
        }
    }
}

void draw_glows(Scene const& scene) {
    for_each_rigid_object(scene, [&](Object const& object) {
        Figure const figure = figure_of(scene, object);
        if (figure.glows) {
            draw_glow(scene, figure);
        }
    });
}

void draw_headings(Scene const& scene) {
    for_each_rigid_object(scene, [&](Object const& object) {
        Figure const figure = figure_of(scene, object);
        scene.for_each_image(figure.position_mm, figure.radius_mm,
                             [&](Vec2 at_mm) { draw_mark(scene, figure, at_mm); });
    });
}

void draw_bodies(Scene const& scene, bool lateral_leds) {
    for (bool const runs_program : {false, true}) {  // robots above what they push
        for_each_rigid_object(scene, [&](Object const& object) {
            if ((object.robot != kNone) == runs_program) {
                draw_figure(scene, figure_of(scene, object), lateral_leds);
            }
        });
    }
}

}  // namespace pogosim
