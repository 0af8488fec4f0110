// Layers that `view:` switches on: labels, arrows, colours by a value, heat maps, and where the camera is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "render/heat_field.hpp"
#include "render/layers.hpp"
#include "render/painter.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::square_world;

constexpr PictureSize kSize{400, 400};
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

ViewOptions nothing() {
    return {.time = false, .scale_bar = false};
}

World world_with(std::vector<Vec2> const& places) {
    World world = square_world();
    for (Vec2 const place : places) {
        add_robot(world, place);
    }
    return world;
}

Snapshot snapshot_of(World const& world) {
    Snapshot snapshot;
    snapshot.scenery = std::make_shared<Scenery const>(make_scenery(world));
    snapshot.position_mm = world.bodies.position_mm;
    snapshot.heading_rad = world.bodies.heading_rad;
    snapshot.led = world.robots.led;
    return snapshot;
}

Canvas painted(Snapshot const& snapshot, ViewOptions const& options) {
    Canvas canvas(kSize);
    Painter().paint(canvas, camera_for(options, snapshot, kSize), snapshot, options);
    return canvas;
}

Pixel at_mm(Canvas const& canvas, Vec2 point_mm) {
    Camera const camera = fitted({{0, 0}, {1000, 1000}}, canvas.size());
    Vec2 const px = camera.to_pixels(point_mm, canvas.size());
    return canvas.pixels()[static_cast<std::size_t>(px.y) * 400 + static_cast<std::size_t>(px.x)];
}

unsigned red(Pixel colour) {
    return colour >> 16U & 0xFFU;
}

std::size_t different_pixels(Canvas const& a, Canvas const& b) {
    return static_cast<std::size_t>(std::inner_product(a.pixels().begin(), a.pixels().end(), b.pixels().begin(), 0L,
                                                       std::plus<>(), std::not_equal_to<>()));
}

TEST(Theme, LightHasALightFloor) {
    Snapshot const snapshot = snapshot_of(world_with({{500, 500}}));
    ViewOptions options = nothing();
    EXPECT_EQ(at_mm(painted(snapshot, options), {200, 200}), palette::kFloor);
    options.theme = Theme::light;
    EXPECT_EQ(at_mm(painted(snapshot, options), {200, 200}), palette::light::kFloor);
    EXPECT_EQ(at_mm(painted(snapshot, options), {490, 500}), palette::light::kDarkLed);
}

TEST(Theme, ChangesWithOnePainterFromPictureToPicture) {
    Snapshot const snapshot = snapshot_of(world_with({{500, 500}}));
    ViewOptions options = nothing();
    Painter painter;
    Canvas canvas(kSize);
    for (Theme const theme : {Theme::dark, Theme::light, Theme::dark}) {
        options.theme = theme;
        painter.paint(canvas, camera_for(options, snapshot, kSize), snapshot, options);
        EXPECT_EQ(different_pixels(canvas, painted(snapshot, options)), 0U);
    }
}

TEST(Camera, KeepsTheRobotThatIsFollowedInTheMiddle) {
    Snapshot const snapshot = snapshot_of(world_with({{100, 200}, {700, 300}}));
    ViewOptions options = nothing();
    options.follow = snapshot.scenery->robot_id[1];
    options.zoom = 4.0;
    Camera const camera = camera_for(options, snapshot, kSize);
    EXPECT_EQ(camera.centre_mm, (Vec2{700, 300}));
    EXPECT_FLOAT_EQ(camera.scale_px_mm, 4.0F * fitted({{0, 0}, {1000, 1000}}, kSize).scale_px_mm);
}

TEST(ColoursByValue, GoFromTheLowestToTheHighestAndNoValueIsGrey) {
    Snapshot snapshot = snapshot_of(world_with({{200, 500}, {500, 500}, {800, 500}}));
    snapshot.color_by = RobotColumn{.name = "heard", .values = {0.0F, 10.0F, kNone}, .low = 0.0F, .high = 10.0F};
    Canvas const canvas = painted(snapshot, nothing());
    EXPECT_EQ(at_mm(canvas, {190, 500}), ThemeColours::of_share(0.0F));
    EXPECT_EQ(at_mm(canvas, {490, 500}), ThemeColours::of_share(1.0F));
    EXPECT_EQ(at_mm(canvas, {790, 500}), palette::kNoLed);
    std::size_t const key = static_cast<std::size_t>(
        std::count(canvas.pixels().begin(), canvas.pixels().end(), ThemeColours::of_share(1.0F)));
    EXPECT_GT(key, 100U);
}

TEST(ColoursByValue, OfEqualValuesAreInTheMiddle) {
    Snapshot snapshot = snapshot_of(world_with({{200, 500}}));
    snapshot.color_by = RobotColumn{.name = "heard", .values = {3.0F}, .low = 3.0F, .high = 3.0F};
    EXPECT_EQ(at_mm(painted(snapshot, nothing()), {190, 500}), ThemeColours::of_share(0.5F));
}

TEST(Velocities, PointToWhereABodyWouldBeAfterASecond) {
    Snapshot snapshot = snapshot_of(world_with({{200, 500}}));
    snapshot.velocity_mm_s = {{300, 0}};
    ViewOptions options = nothing();
    options.velocities = true;
    Canvas const canvas = painted(snapshot, options);
    EXPECT_GT(red(at_mm(canvas, {400, 500})), 0x60U);
    EXPECT_NE(at_mm(canvas, {490, 500}), palette::kFloor);
    EXPECT_EQ(at_mm(canvas, {510, 500}), palette::kFloor);
}

TEST(Velocities, CrossTheSeamOfAPeriodicArena) {
    World world = world_with({{900, 500}});
    world.periodic = true;
    Snapshot snapshot = snapshot_of(world);
    snapshot.velocity_mm_s = {{300, 0}};
    ViewOptions options = nothing();
    options.velocities = true;
    Canvas const canvas = painted(snapshot, options);
    EXPECT_GT(red(at_mm(canvas, {980, 500})), 0x60U);
    EXPECT_GT(red(at_mm(canvas, {100, 500})), 0x60U);
}

TEST(Heard, PointsFromTheSenderAndFades) {
    Snapshot snapshot = snapshot_of(world_with({{200, 500}, {800, 500}}));
    snapshot.time_s = 10.0;
    snapshot.heard = {{.sender = 0, .receiver = 1, .time_s = 10.0}};
    ViewOptions options = nothing();
    options.heard = true;
    auto const brightness = [&](Vec2 where) { return at_mm(painted(snapshot, options), where) >> 8U & 0xFFU; };
    unsigned const fresh = brightness({500, 500});
    EXPECT_GT(brightness({765, 500}), 100U);  // its head is at the receiver
    snapshot.heard[0].time_s = 9.2;
    unsigned const old = brightness({500, 500});
    EXPECT_GT(fresh, old + 50U);
    EXPECT_GT(old, palette::kFloor >> 8U & 0xFFU);
}

TEST(Labels, AreOnRobotsAndNowhereElse) {
    Snapshot const snapshot = snapshot_of(world_with({{200, 500}, {800, 500}}));
    ViewOptions options = nothing();
    Canvas const without = painted(snapshot, options);
    options.labels = true;
    Canvas const with = painted(snapshot, options);
    EXPECT_GT(different_pixels(without, with), 10U);
    for (int y = 0; y < 400; ++y) {
        for (int x = 0; x < 400; ++x) {
            auto const at = static_cast<std::size_t>(y) * 400 + static_cast<std::size_t>(x);
            if (with.pixels()[at] != without.pixels()[at]) {
                Vec2 const px{static_cast<float>(x), static_cast<float>(y)};
                Camera const camera = fitted({{0, 0}, {1000, 1000}}, kSize);
                float const near = std::min(length(px - camera.to_pixels({200, 500}, kSize)),
                                            length(px - camera.to_pixels({800, 500}, kSize)));
                EXPECT_LT(near, 30.0F) << x << ' ' << y;
            }
        }
    }
}

double integral(HeatField const& field) {
    double const cell_m2 = static_cast<double>(field.cell_mm) * static_cast<double>(field.cell_mm) * 1e-6;
    return std::accumulate(field.value.begin(), field.value.end(), 0.0) * cell_m2;
}

TEST(HeatMap, DensityAddsUpToTheNumberOfRobots) {
    EXPECT_NEAR(integral(density_field(snapshot_of(world_with({{500, 500}, {520, 480}, {300, 600}})))), 3.0, 0.01);
    World world = world_with({{2, 2}, {998, 500}});
    EXPECT_LT(integral(density_field(snapshot_of(world))), 1.0);  // the rest is behind walls
    world.periodic = true;
    EXPECT_NEAR(integral(density_field(snapshot_of(world))), 2.0, 0.01);
}

TEST(HeatMap, DensityIsHighestWhereTheRobotIs) {
    HeatField const field = density_field(snapshot_of(world_with({{510, 250}})));
    auto const most = std::ranges::max_element(field.value) - field.value.begin();
    EXPECT_EQ(most % field.columns, static_cast<int>(510.0F / field.cell_mm));
    EXPECT_EQ(most / field.columns, static_cast<int>(250.0F / field.cell_mm));
    double const deviation_m = 0.04;
    EXPECT_NEAR(field.value[static_cast<std::size_t>(most)], 1.0 / (2.0 * 3.14159265 * deviation_m * deviation_m), 5.0);
}

TEST(HeatMap, MeanOfEqualValuesIsThatValueAndFadesFarFromRobots) {
    HeatField const field = mean_field(snapshot_of(world_with({{200, 500}, {300, 500}})), {7.0F, 7.0F});
    for (std::size_t cell = 0; cell < field.value.size(); ++cell) {
        EXPECT_TRUE(field.certainty[cell] == 0.0F || std::abs(field.value[cell] - 7.0F) < 1e-3F);
    }
    EXPECT_EQ(field.certainty.back(), 0.0F);
    EXPECT_EQ(*std::ranges::max_element(field.certainty), 1.0F);
}

TEST(HeatMap, MeanLeavesOutRobotsWithoutAValue) {
    HeatField const field = mean_field(snapshot_of(world_with({{200, 500}, {210, 500}})), {2.0F, kNone});
    EXPECT_NEAR(*std::ranges::max_element(field.value), 2.0F, 1e-4F);
}

TEST(HeatMap, MeanOfAnglesIsThatOfDirections) {
    Snapshot const snapshot = snapshot_of(world_with({{500, 500}, {500, 500}}));
    HeatField const alike = mean_angle_field(snapshot, {3.09F, -3.09F});
    auto const most = static_cast<std::size_t>(std::ranges::max_element(alike.certainty) - alike.certainty.begin());
    EXPECT_NEAR(std::abs(alike.value[most]), 3.14159F, 1e-3F);
    HeatField const opposite = mean_angle_field(snapshot, {0.0F, 3.14159265F});
    EXPECT_LT(*std::ranges::max_element(opposite.certainty), 1e-5F);
}

TEST(HeatMap, ColoursTheFloorWithinTheWalls) {
    Snapshot const snapshot = snapshot_of(world_with({{500, 500}, {500, 560}}));
    ViewOptions options = nothing();
    options.heat_map = kDensity;
    Canvas const canvas = painted(snapshot, options);
    EXPECT_NE(at_mm(canvas, {540, 530}), palette::kFloor);
    EXPECT_EQ(at_mm(canvas, {100, 100}), palette::kFloor);
    EXPECT_EQ(canvas.pixels()[2 * 400 + 2], palette::kPaper);
}

TEST(HeatMap, OfNoRobotsAtAllIsEmpty) {
    ViewOptions options = nothing();
    options.heat_map = kDensity;
    EXPECT_EQ(at_mm(painted(snapshot_of(square_world()), options), {500, 500}), palette::kFloor);
}

}  // namespace
}  // namespace pogosim
