// What a picture costs, by layer: robots on 10^4 mm2 each, with full trails and about four links each, on one core.
// Best of several runs after a warm-up.
//
//     build/release/bench/bench_draw [number of robots ...]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string_view>
#include <vector>

#include "base/random.hpp"
#include "render/background.hpp"
#include "render/layers.hpp"
#include "render/painter.hpp"
#include "support/small_world.hpp"

namespace {

using namespace pogosim;

constexpr float kAreaPerRobotMm2 = 1e4F;
constexpr PictureSize kSize{800, 800};
constexpr int kRuns = 30;

/// Robots that have gone on curves of their own, each long enough for a full trail.
Snapshot swarm(int robots) {
    RandomStream stream(1, 1);
    float const side_mm = std::sqrt(kAreaPerRobotMm2 * static_cast<float>(robots));
    World world = testing::square_world(side_mm);
    std::vector<float> turn(static_cast<std::size_t>(robots));
    for (int i = 0; i < robots; ++i) {
        auto const coordinate = [&] { return side_mm * stream.uniform(); };
        float const heading = 2.0F * std::numbers::pi_v<float> * stream.uniform();
        testing::add_robot(world, {coordinate(), coordinate()}, heading);
        turn[static_cast<std::size_t>(i)] = 0.04F * stream.uniform() - 0.02F;
    }
    Trails trails;
    for (std::size_t step = 0; step <= Trails::kLength; ++step) {
        for (std::size_t i = 0; i < turn.size(); ++i) {
            auto const colour = static_cast<unsigned>((i + step / 100U) % 6U) + 1U;
            auto const led = [&](unsigned bit) { return static_cast<std::uint8_t>((colour & bit) != 0 ? 25 : 0); };
            world.robots.led[i][0] = {led(1), led(2), led(4)};
            world.bodies.heading_rad[i] += turn[i];
            Vec2& at = world.bodies.position_mm[i];
            at = at + 1.01F * Trails::kSpacingMm * direction(world.bodies.heading_rad[i]);
            at = {std::clamp(at.x, 0.0F, side_mm), std::clamp(at.y, 0.0F, side_mm)};
        }
        trails.follow(world);
    }
    Snapshot snapshot;
    snapshot.scenery = std::make_shared<Scenery const>(make_scenery(world));
    snapshot.position_mm = world.bodies.position_mm;
    snapshot.heading_rad = world.bodies.heading_rad;
    snapshot.led = world.robots.led;
    snapshot.trails = std::make_shared<Trails const>(std::move(trails));
    snapshot.time_s = 60.0;
    constexpr float kReachMm = 113.0F;  // of which a disk holds four others
    for (std::uint32_t a = 0; a < turn.size(); ++a) {
        for (std::uint32_t b = a + 1; b < turn.size(); ++b) {
            Vec2 const between = snapshot.position_mm[b] - snapshot.position_mm[a];
            if (length(between) < kReachMm && length(between) > 53.0F) {
                Vec2 const rim = (26.5F / length(between)) * between;
                snapshot.links.push_back({.from = a,
                                          .to = b,
                                          .from_mm = snapshot.position_mm[a] + rim,
                                          .to_mm = snapshot.position_mm[b] - rim,
                                          .emitters = static_cast<std::uint8_t>(1U << (a % 4U)),
                                          .emitters_back = static_cast<std::uint8_t>(b % 3U == 0 ? 0U : 1U)});
            }
        }
    }
    return snapshot;
}

/// In processor time, which counts only the own work where others are busy, too.
double best_ms(std::function<void()> const& draw) {
    draw();
    double best = std::numeric_limits<double>::infinity();
    for (int run = 0; run < kRuns; ++run) {
        std::clock_t const begin = std::clock();
        draw();
        best = std::min(best, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    return 1e3 * best;
}

void measure(int robots) {
    Snapshot const snapshot = swarm(robots);
    Camera const camera = fitted(snapshot.scenery->arena.bounds, kSize);
    Canvas canvas(kSize);
    Background background;
    ThemeColours const colours;
    background.draw(canvas, camera, snapshot, colours, false);
    Scene const scene{canvas, camera, snapshot, background.floor(), colours};
    Text text;
    Painter painter;
    ViewOptions const all{.links = LinkLayer::below, .trails = true};
    fmt::print("{} robots, {} links, {} x {} pixels\n", robots, snapshot.links.size(), kSize.width_px, kSize.height_px);
    auto const print = [](std::string_view layer, std::function<void()> const& draw) {
        fmt::print("    {:<18}{:>8.2f} ms\n", layer, best_ms(draw));
    };
    print("new background", [&] { Background().draw(canvas, camera, snapshot, colours, false); });
    print("same background", [&] { background.draw(canvas, camera, snapshot, colours, false); });
    print("links", [&] { draw_links(scene); });
    print("trails", [&] { draw_trails(scene); });
    print("glows", [&] { draw_glows(scene); });
    print("bodies", [&] { draw_bodies(scene, true); });
    print("scale bar, time", [&] {
        draw_scale_bar(scene, text);
        draw_time(scene, text);
    });
    print("whole picture", [&] { painter.paint(canvas, camera, snapshot, all); });
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<int> sizes;
    for (int i = 1; i < argc; ++i) {
        sizes.push_back(std::atoi(argv[i]));
    }
    if (std::any_of(sizes.begin(), sizes.end(), [](int n) { return n < 1 || n > 10000; })) {
        fmt::print(stderr, "Usage: {} [number of robots, 1 to 10000 ...]\n", argv[0]);
        return 2;
    }
    if (sizes.empty()) {
        sizes = {100, 1000};
    }
    std::for_each(sizes.begin(), sizes.end(), measure);
    return EXIT_SUCCESS;
}
