#include <algorithm>
#include <cmath>

#include "render/layers.hpp"
#include "render/led_colour.hpp"

namespace pogosim {

namespace {

// Short steps are gathered into pieces, each as straight as can be seen.
constexpr float kShortestPiecePx = 1.0F;
constexpr float kLongestPiecePx = 6.0F;
constexpr float kBendPx = 0.6F;  // of a piece, away from its first step: four times as far as the arc is from its chord

struct Pen {
    float width_px;
    Pixel colour;
};

/// Opacity of a trail by age: 0 at its end, 1 at the robot.
Pen pen_at(float freshness, float unit_px, Pixel colour) {
    float const opacity = 0.04F + 0.7F * freshness * freshness * freshness;
    return {(0.5F + 0.9F * freshness) * unit_px, with_opacity(colour, opacity)};
}

/// Whether a piece of a trail is still too short to be drawn, or straight enough to become longer.
bool can_go_on(Vec2 piece, Vec2 first_step) {
    float const size = squared_length(piece);
    float const bend = cross(first_step, piece);
    bool const is_short = size < kShortestPiecePx * kShortestPiecePx;
    bool const is_straight = bend * bend < kBendPx * kBendPx * squared_length(first_step);
    return is_short || (is_straight && size < kLongestPiecePx * kLongestPiecePx);
}

}  // namespace

void draw_trails(Scene const& scene) {
    Trails const& trails = *scene.snapshot.trails;
    Scenery const& scenery = scene.scenery();
    Vec2 const half_arena = 0.5F * scenery.arena.bounds.size();
    auto const is_far = [&](Vec2 a, Vec2 b) {
        return std::abs(a.x - b.x) > half_arena.x || std::abs(a.y - b.y) > half_arena.y;
    };
    std::size_t const robots = std::min(trails.robot_count(), scenery.robot_body.size());
    for (std::size_t robot = 0; robot < robots; ++robot) {
        std::size_t const points = trails.size(robot);
        if (points == 0 || scenery.robot_body[robot] == kNone) {
            continue;
        }
        float const radius_px = scene.to_pixels(scenery.body_radius_mm[scenery.robot_body[robot]]);
        float const unit_px = std::clamp(0.12F * radius_px, 0.5F, scene.point_px());
        TrailPoint last = trails.point(robot, points - 1);
        Vec2 drawn_to = scene.to_pixels(last.position_mm);
        Vec2 first_step{};  // of the piece
        auto const go_to = [&](TrailPoint const& point, std::size_t age, bool is_end) {
            Vec2 const here = scene.to_pixels(point.position_mm);
            Vec2 const piece = here - drawn_to;
            auto const pen_here = [&] {
                float const freshness = 1.0F - static_cast<float>(age) / static_cast<float>(trails.fading());
                return pen_at(freshness, unit_px,
                              shown_colour(scene.snapshot, scene.colours, point.led, scene.colours.dark_led));
            };
            if (is_far(last.position_mm, point.position_mm)) {
                // Across a seam: both ends of the shortest way. Else it has been put there, which leaves no trail.
                if (scenery.periodic) {
                    Pen const pen = pen_here();
                    Vec2 const step_px = scene.camera.scale_px_mm * scene.from_to(last.position_mm, point.position_mm);
                    scene.canvas.chain_link(drawn_to, scene.to_pixels(last.position_mm) + step_px, pen.width_px,
                                            pen.colour);
                    scene.canvas.chain_link(here - step_px, here, pen.width_px, pen.colour);
                }
                drawn_to = here;
            } else {
                first_step = first_step == Vec2{} ? piece : first_step;
                if (point.led == last.led && !is_end && can_go_on(piece, first_step)) {
                    last.position_mm = point.position_mm;
                    return;
                }
                Pen const pen = pen_here();
                scene.canvas.chain_link(drawn_to, here, pen.width_px, pen.colour);
                drawn_to = here;
            }
            first_step = {};
            last = point;
        };
        for (std::size_t age = points - 1; age-- > 0;) {
            go_to(trails.point(robot, age), age, false);
        }
        go_to({scene.snapshot.position_mm[scenery.robot_body[robot]], scene.snapshot.led[robot][0]}, 0, true);
    }
}

}  // namespace pogosim
