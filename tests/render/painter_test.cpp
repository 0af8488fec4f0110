#include "render/painter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "render/layers.hpp"
#include "render/led_colour.hpp"
#include "render/text.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::square_world;

constexpr PictureSize kSize{400, 400};
ViewOptions const kNothingWritten{.time = false, .scale_bar = false};
constexpr Rgb kRed{25, 0, 0};
constexpr Rgb kGreen{0, 25, 0};
constexpr Pixel kLitRed = 0xFFD20000;
constexpr Pixel kLitGreen = 0xFF00D200;

/// What the world's makers fill in later; of the small world's bodies and robots.
Snapshot snapshot_of(World const& world) {
    Snapshot snapshot;
    snapshot.scenery = std::make_shared<Scenery const>(make_scenery(world));
    snapshot.position_mm = world.bodies.position_mm;
    snapshot.heading_rad = world.bodies.heading_rad;
    snapshot.led = world.robots.led;
    return snapshot;
}

Canvas painted(Snapshot const& snapshot, ViewOptions const& options = kNothingWritten, PictureSize size = kSize) {
    Canvas canvas(size);
    Painter painter;
    painter.paint(canvas, fitted(snapshot.scenery->arena.bounds, size), snapshot, options);
    return canvas;
}

Pixel at(Canvas const& canvas, int x, int y) {
    return canvas.pixels()[static_cast<std::size_t>(y * canvas.size().width_px + x)];
}

/// The pixel of a point of a 1000 mm arena fitted into the picture.
Pixel at_mm(Canvas const& canvas, Vec2 point_mm) {
    Camera const camera = fitted({{0, 0}, {1000, 1000}}, canvas.size());
    Vec2 const px = camera.to_pixels(point_mm, canvas.size());
    return at(canvas, static_cast<int>(px.x), static_cast<int>(px.y));
}

std::vector<Pixel> pixels_of(Canvas const& canvas) {
    return {canvas.pixels().begin(), canvas.pixels().end()};
}

std::size_t different_pixels(Canvas const& a, Canvas const& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        count += a.pixels()[i] != b.pixels()[i] ? 1U : 0U;
    }
    return count;
}

std::size_t pixels_like(Canvas const& canvas, Pixel colour) {
    return static_cast<std::size_t>(std::count(canvas.pixels().begin(), canvas.pixels().end(), colour));
}

TEST(Led, IsBrightAtLowValuesAlready) {
    EXPECT_EQ(led_colour({0, 0, 0}), palette::kDarkLed);
    EXPECT_EQ(led_colour({1, 0, 0}), 0xFF640000U);
    EXPECT_EQ(led_colour({0, 13, 0}), 0xFF009B00U);
    EXPECT_EQ(led_colour({0, 0, 25}), 0xFF0000D2U);
    EXPECT_EQ(led_colour({255, 26, 0}), 0xFFD2D200U);
}

TEST(Picture, HasPaperAroundTheFloorAndInItsHoles) {
    World world = square_world();
    for (bool const is_reversed : {false, true}) {
        Polygon hole{{400, 400}, {600, 400}, {600, 600}, {400, 600}};
        if (is_reversed) {
            std::reverse(hole.begin(), hole.end());
        }
        world.arena.polygons.resize(1);
        world.arena.polygons.push_back(hole);
        Canvas const canvas = painted(snapshot_of(world), kNothingWritten, {1600, 1600});
        EXPECT_EQ(at(canvas, 2, 2), palette::kPaper);
        EXPECT_EQ(at_mm(canvas, {200, 200}), palette::kFloor);
        EXPECT_EQ(at_mm(canvas, {500, 500}), palette::kPaper);
        EXPECT_EQ(at_mm(canvas, {0, 500}), palette::kWall);
    }
}

TEST(Robot, HasTheColourOfItsHeadLedAndAMarkWhereItHeads) {
    World world = square_world();
    add_robot(world, {300, 300}, 0.0F);
    add_robot(world, {700, 300}, 0.5F * std::numbers::pi_v<float>);
    add_robot(world, {300, 700}, 1.0F);
    world.robots.led[0][0] = kGreen;
    world.robots.led[1][0] = kRed;
    Canvas const canvas = painted(snapshot_of(world), kNothingWritten, {1600, 1600});
    EXPECT_EQ(at_mm(canvas, {290, 300}), kLitGreen);
    EXPECT_EQ(at_mm(canvas, {300, 315}), kLitGreen);
    EXPECT_EQ(at_mm(canvas, {315, 300}), palette::kEdge);
    EXPECT_EQ(at_mm(canvas, {700, 290}), kLitRed);
    EXPECT_EQ(at_mm(canvas, {700, 315}), palette::kPaper);  // stands out from dark red
    EXPECT_EQ(at_mm(canvas, {295, 695}), palette::kDarkLed);
}

TEST(Robot, ThatIsLitGlowsOnTheFloorOnly) {
    World world = square_world();
    add_robot(world, {27, 500});
    Canvas const dark = painted(snapshot_of(world));
    world.robots.led[0][0] = kGreen;
    Canvas const lit = painted(snapshot_of(world));
    EXPECT_NE(at_mm(lit, {27, 535}), at_mm(dark, {27, 535}));
    EXPECT_EQ(at_mm(lit, {27, 560}), palette::kFloor);
    EXPECT_EQ(at_mm(lit, {-15, 500}), palette::kPaper);
}

TEST(Robot, ShowsItsLateralLedsOnItsRim) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.3F);
    world.robots.led[0] = {Rgb{}, kRed, kGreen, {0, 0, 25}, {25, 25, 0}};
    for (bool const is_turned : {false, true}) {
        world.categories[0].spec.robot->rotate_leds_45_deg = is_turned;
        Canvas const canvas = painted(snapshot_of(world), kNothingWritten, {1600, 1600});
        Pixel const colours[] = {kLitRed, kLitGreen, 0xFF0000D2, 0xFFD2D200};
        for (int k = 0; k < 4; ++k) {
            float const quarters = static_cast<float>(k) + (is_turned ? 0.5F : 0.0F);
            Vec2 const towards = direction(0.3F + quarters * 0.5F * std::numbers::pi_v<float>);
            EXPECT_EQ(at_mm(canvas, Vec2{500, 500} + 22.5F * towards), colours[k]) << k << is_turned;
        }
        ViewOptions without = kNothingWritten;
        without.lateral_leds = false;
        Canvas const plain = painted(snapshot_of(world), without, {1600, 1600});
        EXPECT_EQ(pixels_like(plain, kLitGreen), 0U);
    }
}

TEST(Body, HasItsShape) {
    World world = square_world();
    ObjectSpec spec = testing::pogobot_spec();
    spec.shape = {.kind = ShapeKind::rectangle, .width_mm = 400.0F, .height_mm = 100.0F};
    add_robot(world, {500, 500}, 0.5F * std::numbers::pi_v<float>, spec);
    world.robots.led[0][0] = kRed;
    Canvas const canvas = painted(snapshot_of(world));
    EXPECT_EQ(at_mm(canvas, {540, 350}), kLitRed);
    EXPECT_EQ(at_mm(canvas, {460, 650}), kLitRed);
    EXPECT_NE(at_mm(canvas, {570, 500}), kLitRed);
    EXPECT_NEAR(static_cast<double>(pixels_like(canvas, kLitRed)) / (400.0 * 100.0 * 0.38 * 0.38), 0.93, 0.06);
}

TEST(Body, WithoutAProgramHasAColourOfItsOwn) {
    World world = square_world();
    add_robot(world, {500, 500});
    world.objects[0].robot = kNone;
    Canvas const canvas = painted(snapshot_of(world));
    EXPECT_EQ(at_mm(canvas, {490, 510}), palette::kNoLed);
}

TEST(Body, OnTheSeamOfAPeriodicArenaShowsOnBothSidesAndNowhereElse) {
    World world = square_world();
    world.periodic = true;
    add_robot(world, {2.0F, 3.0F});
    world.robots.led[0][0] = kGreen;
    Canvas const canvas = painted(snapshot_of(world));
    for (Vec2 const inside : {Vec2{10, 12}, Vec2{990, 12}, Vec2{10, 990}, Vec2{990, 990}}) {
        EXPECT_EQ(at_mm(canvas, inside), kLitGreen);
    }
    EXPECT_EQ(at_mm(canvas, {-10, 10}), palette::kPaper);
    EXPECT_EQ(at_mm(canvas, {1010, 1010}), palette::kPaper);
}

TEST(Membrane, IsARingOfDotsAlsoAcrossASeam) {
    World world = square_world();
    world.periodic = true;
    ObjectSpec spec = testing::pogobot_spec();
    spec.membrane.emplace();
    spec.membrane->radius_mm = 10.0F;
    spec.shape.radius_mm = 10.0F;
    constexpr int kDots = 40;
    for (int i = 0; i < kDots; ++i) {
        Vec2 const on_ring = 100.0F * direction(2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kDots);
        add_robot(world, wrapped(world, Vec2{20, 500} + on_ring), 0.0F, spec);
    }
    world.objects.resize(1);
    world.objects[0].body_count = kDots;
    world.robots.led[0][0] = kGreen;
    Snapshot const snapshot = snapshot_of(world);
    Canvas const canvas = painted(snapshot);
    EXPECT_EQ(at_mm(canvas, {120, 500}), kLitGreen);
    EXPECT_EQ(at_mm(canvas, {920, 500}), kLitGreen);
    EXPECT_EQ(at_mm(canvas, {500, 500}), palette::kFloor);  // no line across the arena
    EXPECT_EQ(at_mm(canvas, {60, 500}), palette::kFloor);
}

TEST(Wall, WithAProgramGlowsInItsColour) {
    World world = square_world();
    add_robot(world, {500, 500});
    world.robots.body[0] = kNone;
    world.objects[0].body = kNone;
    world.objects[0].body_count = 0;
    world.outlines.push_back({.robot = 0, .polygons = world.arena.polygons});
    Canvas const dark = painted(snapshot_of(world), kNothingWritten, {1600, 1600});
    EXPECT_EQ(at_mm(dark, {0, 500}), palette::kDarkWall);
    world.robots.led[0][0] = kRed;
    Canvas const lit = painted(snapshot_of(world), kNothingWritten, {1600, 1600});
    EXPECT_EQ(at_mm(lit, {0, 500}), kLitRed);
    EXPECT_GT(at_mm(lit, {8, 500}) >> 16U & 0xFFU, palette::kFloor >> 16U & 0xFFU);
    EXPECT_EQ(at_mm(lit, {500, 500}), palette::kFloor);
    EXPECT_EQ(at_mm(lit, {-20, 500}), palette::kPaper);
}

Snapshot lit_world(std::vector<std::int16_t> const& level) {
    World const world = square_world();
    Snapshot snapshot = snapshot_of(world);
    snapshot.light = std::make_shared<LightMap const>(
        LightMap{.columns = 2, .rows = 1, .origin_mm = {0, 0}, .cell_mm = {500, 1000}, .level = level});
    return snapshot;
}

TEST(Light, BrightensTheFloorWhereThereIsMoreOfIt) {
    ViewOptions options = kNothingWritten;
    options.light_levels = true;
    Canvas const canvas = painted(lit_world({0, 100}), options);
    EXPECT_EQ(at_mm(canvas, {200, 500}), palette::kFloor);
    Pixel const bright = at_mm(canvas, {800, 500});
    EXPECT_NEAR(bright >> 16U & 0xFFU, 0x12 + palette::kBrightestLamplight * (0xFF - 0x12), 1.5);
    Pixel const between = at_mm(canvas, {500, 500});
    EXPECT_LT(between, bright);
    EXPECT_GT(between, palette::kFloor);
    EXPECT_EQ(at(canvas, 3, 3), palette::kPaper);
}

TEST(Light, ThatIsEvenOrNotAskedForShowsNothing) {
    ViewOptions options = kNothingWritten;
    Canvas const without = painted(lit_world({0, 100}), options);
    options.light_levels = true;
    EXPECT_EQ(pixels_of(painted(lit_world({300, 300}), options)), pixels_of(without));
}

Snapshot linked_world(std::uint8_t emitters, std::uint8_t emitters_back) {
    World world = square_world();
    add_robot(world, {200, 500});
    add_robot(world, {800, 500});
    Snapshot snapshot = snapshot_of(world);
    snapshot.links.push_back({.from = 0,
                              .to = 1,
                              .from_mm = {227, 500},
                              .to_mm = {773, 500},
                              .emitters = emitters,
                              .emitters_back = emitters_back});
    return snapshot;
}

bool looks_like(Pixel pixel, Pixel colour, int tolerance = 40) {
    for (unsigned const shift : {0U, 8U, 16U}) {
        if (std::abs(static_cast<int>(pixel >> shift & 0xFFU) - static_cast<int>(colour >> shift & 0xFFU)) >
            tolerance) {
            return false;
        }
    }
    return true;
}

// ---- Links between bodies ----

Canvas painted_with(BodyLink const& link, bool is_periodic = false) {
    World world = square_world();
    world.periodic = is_periodic;
    Snapshot snapshot = snapshot_of(world);
    snapshot.body_links = {link};
    return painted(snapshot, kNothingWritten, {1600, 1600});
}

TEST(BodyLink, GoesFromEndToEndInTheColourOfItsTension) {
    BodyLink link{.from_mm = {200, 500}, .to_mm = {800, 500}};
    for (auto const& [load, colour] : {std::pair{0.0F, palette::kLinkAtRest}, std::pair{1.0F, palette::kLinkPulled},
                                       std::pair{-1.0F, palette::kLinkPushed}, std::pair{7.0F, palette::kLinkPulled}}) {
        link.load = load;
        Canvas const canvas = painted_with(link);
        EXPECT_EQ(at_mm(canvas, {201, 500}), colour) << load;
        EXPECT_EQ(at_mm(canvas, {500, 500}), colour) << load;
        EXPECT_EQ(at_mm(canvas, {799, 500}), colour) << load;
        EXPECT_EQ(at_mm(canvas, {500, 510}), palette::kFloor) << load;
        EXPECT_EQ(at_mm(canvas, {190, 500}), palette::kFloor) << load;
    }
}

TEST(BodyLink, ColoursOfTensionsAreBetweenThoseOfTheirLimits) {
    EXPECT_EQ(tension_colour({}, 0.0F), palette::kLinkAtRest);
    Pixel const half = tension_colour({}, 0.5F);
    EXPECT_NEAR(static_cast<float>(half >> 8U & 0xFFU),
                0.5F * static_cast<float>((palette::kLinkAtRest >> 8U & 0xFFU) + (palette::kLinkPulled >> 8U & 0xFFU)),
                1.0F);
    EXPECT_EQ(half >> 24U, 0xFFU);
}

TEST(BodyLink, IsDrawnAboveRobotsAndBelowTheirHeadings) {
    World world = square_world();
    add_robot(world, {500, 500});
    Snapshot snapshot = snapshot_of(world);
    snapshot.body_links = {{.from_mm = {500, 500}, .to_mm = {600, 500}, .load = 1.0F}};
    Canvas const canvas = painted(snapshot, kNothingWritten, {1600, 1600});
    EXPECT_EQ(at_mm(canvas, {502, 500}), palette::kLinkPulled);
    EXPECT_EQ(at_mm(canvas, {515, 500}), ThemeColours{}.contrast_to(led_colour({})));  // where it heads
    EXPECT_EQ(at_mm(canvas, {540, 500}), palette::kLinkPulled);
}

TEST(BodyLink, HingeIsADot) {
    Canvas const canvas = painted_with({.kind = LinkKind::hinge, .from_mm = {500, 500}, .to_mm = {500, 500}});
    EXPECT_EQ(at_mm(canvas, {500, 500}), palette::kLinkAtRest);
    EXPECT_EQ(at_mm(canvas, {503, 500}), palette::kLinkAtRest);
    EXPECT_EQ(at_mm(canvas, {500, 503}), palette::kLinkAtRest);
    EXPECT_EQ(at_mm(canvas, {510, 500}), palette::kFloor);
}

TEST(BodyLink, AcrossTheSeamShowsOnBothSides) {
    Canvas const canvas = painted_with({.from_mm = {950, 500}, .to_mm = {1050, 500}}, true);
    EXPECT_EQ(at_mm(canvas, {990, 500}), palette::kLinkAtRest);
    EXPECT_EQ(at_mm(canvas, {20, 500}), palette::kLinkAtRest);
    EXPECT_EQ(at_mm(canvas, {60, 500}), palette::kFloor);
    EXPECT_EQ(at_mm(canvas, {1010, 500}), palette::kPaper);
}

TEST(Link, HasTheColourOfEachSendersEmitterOnItsHalf) {
    for (LinkLayer const layer : {LinkLayer::below, LinkLayer::above}) {
        ViewOptions options = kNothingWritten;
        options.links = layer;
        Canvas const canvas = painted(linked_world(0b0110, 0b1000), options, {1600, 1600});
        EXPECT_TRUE(looks_like(at_mm(canvas, {300, 500}), palette::kLinkByEmitter[1]));
        EXPECT_TRUE(looks_like(at_mm(canvas, {700, 500}), palette::kLinkByEmitter[3]));
        Canvas const all = painted(linked_world(kAllFaces, 0b0001), options, {1600, 1600});
        EXPECT_TRUE(looks_like(at_mm(all, {300, 500}), palette::kLinkByAllEmitters));
        EXPECT_TRUE(looks_like(at_mm(all, {700, 500}), palette::kLinkByEmitter[0]));
    }
}

TEST(Link, OfOneWayFadesAndEndsInAnArrowHead) {
    ViewOptions options = kNothingWritten;
    options.links = LinkLayer::below;
    Canvas const canvas = painted(linked_world(0b0001, 0), options, {1600, 1600});
    EXPECT_TRUE(looks_like(at_mm(canvas, {300, 500}), palette::kLinkByEmitter[0]));
    EXPECT_FALSE(looks_like(at_mm(canvas, {720, 500}), palette::kLinkByEmitter[0]));
    EXPECT_TRUE(looks_like(at_mm(canvas, {767, 500}), palette::kLinkByEmitter[0]));
    EXPECT_TRUE(looks_like(at_mm(canvas, {765, 501.5F}), palette::kLinkByEmitter[0]));
}

TEST(Link, AcrossTheSeamShowsOnBothSides) {
    World world = square_world();
    world.periodic = true;
    add_robot(world, {950, 500});
    add_robot(world, {50, 500});
    Snapshot snapshot = snapshot_of(world);
    snapshot.links.push_back(
        {.from = 0, .to = 1, .from_mm = {977, 500}, .to_mm = {1023, 500}, .emitters = 1, .emitters_back = 2});
    ViewOptions options = kNothingWritten;
    options.links = LinkLayer::above;
    Canvas const canvas = painted(snapshot, options, {1600, 1600});
    EXPECT_TRUE(looks_like(at_mm(canvas, {985, 500}), palette::kLinkByEmitter[0]));
    EXPECT_TRUE(looks_like(at_mm(canvas, {15, 500}), palette::kLinkByEmitter[1]));
    EXPECT_EQ(at_mm(canvas, {1010, 500}), palette::kPaper);
}

TEST(Trail, IsDrawnWhereTheRobotWasInTheColourOfTheTime) {
    World world = square_world();
    add_robot(world, {100, 500});
    Trails trails;
    for (int x = 100; x <= 900; x += 2) {
        world.robots.led[0][0] = x < 500 ? kRed : kGreen;
        world.bodies.position_mm[0].x = static_cast<float>(x);
        trails.follow(world);
    }
    Snapshot snapshot = snapshot_of(world);
    snapshot.trails = std::make_shared<Trails const>(trails);
    ViewOptions options = kNothingWritten;
    Canvas const without = painted(snapshot, options, {1600, 1600});
    EXPECT_EQ(at_mm(without, {700, 500}), palette::kFloor);
    options.trails = true;
    Canvas const canvas = painted(snapshot, options, {1600, 1600});
    auto const red = [](Pixel pixel) { return static_cast<int>(pixel >> 16U & 0xFFU); };
    auto const green = [](Pixel pixel) { return static_cast<int>(pixel >> 8U & 0xFFU); };
    EXPECT_GT(red(at_mm(canvas, {480, 500})), green(at_mm(canvas, {480, 500})));
    EXPECT_GT(green(at_mm(canvas, {800, 500})), green(at_mm(canvas, {550, 500})));
    EXPECT_GT(red(at_mm(canvas, {480, 500})), red(at_mm(canvas, {200, 500})));
}

TEST(Trail, IsNeverDrawnAcrossTheSeam) {
    World world = square_world();
    world.periodic = true;
    add_robot(world, {900, 500});
    Trails trails;
    for (int x = 900; x <= 1100; x += 2) {
        world.bodies.position_mm[0] = {static_cast<float>(x % 1000), 500};
        trails.follow(world);
    }
    Snapshot snapshot = snapshot_of(world);
    snapshot.trails = std::make_shared<Trails const>(trails);
    ViewOptions options = kNothingWritten;
    options.trails = true;
    Canvas const canvas = painted(snapshot, options);
    EXPECT_NE(at_mm(canvas, {50, 500}), palette::kFloor);
    for (float x = 150; x < 850; x += 10.0F) {
        EXPECT_EQ(at_mm(canvas, {x, 500}), palette::kFloor);
    }
}

TEST(Lamp, HasAMarkItsOutlineAndItsBeam) {
    World const world = square_world();
    Snapshot snapshot = snapshot_of(world);
    snapshot.lamps.push_back({.centre_mm = {500, 500},
                              .shape = {.kind = ShapeKind::disk, .radius_mm = 200.0F},
                              .shape_mm = {500, 500},
                              .has_beam = true,
                              .beam_rad = 0.0F,
                              .beam_is_on = true});
    Canvas const canvas = painted(snapshot, kNothingWritten, {1600, 1600});
    EXPECT_EQ(at_mm(canvas, {500, 500}), palette::kLamp);
    EXPECT_NE(at_mm(canvas, {500, 700}), palette::kFloor);
    EXPECT_NE(at_mm(canvas, {900, 500}), palette::kFloor);
    EXPECT_EQ(at_mm(canvas, {200, 500}), palette::kFloor);
    EXPECT_EQ(at_mm(canvas, {1010, 500}), palette::kPaper);
}

TEST(Selection, HasARingAroundIt) {
    World world = square_world();
    add_robot(world, {300, 300});
    add_robot(world, {700, 700});
    Snapshot const snapshot = snapshot_of(world);
    ViewOptions options = kNothingWritten;
    options.selected_robot = 1;
    Canvas const canvas = painted(snapshot, options, {1600, 1600});
    EXPECT_GT(pixels_like(canvas, palette::kSelectionRim), 100U);
    options.selected_robot = 2;  // of a run before
    EXPECT_EQ(pixels_of(painted(snapshot, options)), pixels_of(painted(snapshot)));
}

TEST(Painter, GivesEqualPixelsForEqualSnapshotsWhateverItDrewBefore) {
    World world = square_world();
    add_robot(world, {300, 300});
    add_robot(world, {700, 300}, 1.0F);
    add_robot(world, {500, 500});
    world.robots.body[2] = kNone;
    world.objects[2].body = kNone;
    world.objects[2].body_count = 0;
    world.outlines.push_back({.robot = 2, .polygons = world.arena.polygons});
    Painter painter;
    Canvas canvas(kSize);
    Box const bounds = world.arena.bounds;
    Snapshot snapshot = snapshot_of(world);
    for (int change = 0; change < 8; ++change) {
        ViewOptions options;
        Camera camera = fitted(bounds, kSize);
        if (change == 1) {
            snapshot.led[2][0] = kRed;
        } else if (change == 2) {
            camera = zoomed(camera, 2.0F, {10.0F, 20.0F}, kSize, zoom_limits(bounds, kSize));
        } else if (change >= 3) {
            auto const level = static_cast<std::int16_t>(change == 4 ? 0 : change);
            snapshot.light = lit_world({0, level}).light;
            options.light_levels = change != 6;
        }
        if (change == 7) {
            canvas.resize({200, 300});
            camera = fitted(bounds, canvas.size());
        }
        painter.paint(canvas, camera, snapshot, options);
        Canvas fresh(canvas.size());
        Painter().paint(fresh, camera, snapshot, options);
        EXPECT_EQ(different_pixels(canvas, fresh), 0U) << change;
    }
}

TEST(Painter, DrawsOtherSceneriesAnew) {
    World world = square_world();
    Painter painter;
    Canvas canvas(kSize);
    Snapshot first = snapshot_of(world);
    Camera const camera = fitted(world.arena.bounds, kSize);
    painter.paint(canvas, camera, first, kNothingWritten);
    EXPECT_EQ(at_mm(canvas, {500, 500}), palette::kFloor);
    world.arena.polygons.push_back({{400, 400}, {600, 400}, {600, 600}, {400, 600}});
    painter.paint(canvas, camera, snapshot_of(world), kNothingWritten);
    EXPECT_EQ(at_mm(canvas, {500, 500}), palette::kPaper);
}

TEST(Painter, AsksForThePartsThatItDraws) {
    EXPECT_EQ(parts_for({}), SnapshotParts{});
    EXPECT_TRUE(parts_for({.links = LinkLayer::above}).links);
    EXPECT_TRUE(parts_for({.light_levels = true}).light);
    EXPECT_TRUE(parts_for({.trails = true}).trails);
}

TEST(Picture, OfAnySizeWithStrangePositionsIsDrawn) {
    World world = square_world();
    for (bool const is_periodic : {false, true}) {
        world.periodic = is_periodic;
        for (int i = 0; i < 4; ++i) {
            add_robot(world, {500, 500});
            world.robots.led.back() = {kRed, kRed, kGreen, kRed, kRed};
        }
        Snapshot snapshot = snapshot_of(world);
        snapshot.position_mm[0] = {std::numeric_limits<float>::quiet_NaN(), 5.0F};
        snapshot.position_mm[1] = {std::numeric_limits<float>::infinity(), 5.0F};
        snapshot.position_mm[2] = {1e30F, -1e30F};
        snapshot.heading_rad[3] = std::numeric_limits<float>::quiet_NaN();
        snapshot.links.push_back(
            {.from = 0, .to = 1, .from_mm = snapshot.position_mm[0], .to_mm = {1e30F, 0}, .emitters = 1});
        snapshot.lamps.push_back({.centre_mm = {1e30F, 0}, .shape = {}, .has_beam = true, .beam_is_on = true});
        ViewOptions options{.links = LinkLayer::above, .light_levels = true, .trails = true, .selected_robot = 1};
        for (PictureSize const size : {PictureSize{1, 1}, PictureSize{0, 0}, PictureSize{3, 2000}, kSize}) {
            Canvas const canvas = painted(snapshot, options, size);
            EXPECT_EQ(canvas.size(), size);
        }
    }
}

TEST(Picture, OfASinglePixelIsTheFloor) {
    EXPECT_TRUE(looks_like(painted(snapshot_of(square_world()), {}, {1, 1}).pixels()[0], palette::kFloor, 80));
}

TEST(ScaleBar, HasARoundLength) {
    EXPECT_DOUBLE_EQ(round_length(263.0), 200.0);
    EXPECT_DOUBLE_EQ(round_length(0.0713), 0.05);
    EXPECT_DOUBLE_EQ(round_length(1999.0), 1000.0);
    EXPECT_DOUBLE_EQ(round_length(100.0), 100.0);
}

TEST(ScaleBar, AndTimeAreWrittenInTheirCorners) {
    World const world = square_world();
    Snapshot const snapshot = snapshot_of(world);
    auto const changed_in = [&](ViewOptions const& options) {
        Canvas const with = painted(snapshot, options);
        Canvas const without = painted(snapshot, kNothingWritten);
        std::set<int> quarters;
        for (int y = 0; y < kSize.height_px; ++y) {
            for (int x = 0; x < kSize.width_px; ++x) {
                if (at(with, x, y) != at(without, x, y)) {
                    quarters.insert((y < kSize.height_px / 2 ? 0 : 2) + (x < kSize.width_px / 2 ? 0 : 1));
                }
            }
        }
        return quarters;
    };
    EXPECT_EQ(changed_in({.time = true, .scale_bar = false}), std::set<int>{1});
    EXPECT_EQ(changed_in({.time = false, .scale_bar = true}), std::set<int>{2});
}

// What is drawn where, and above what.

/// A picture that shows paper alone, but for what is written into it.
constexpr Camera kFarAway{.centre_mm = {1e5F, 1e5F}, .scale_px_mm = 0.38F};

/// The smallest box with all pixels that are not of the background.
PixelBox box_of_drawn(Canvas const& canvas, PixelBox const& within, Pixel background = palette::kPaper) {
    PixelBox box{within.right, within.bottom, within.left, within.top};
    for (int y = within.top; y < within.bottom; ++y) {
        for (int x = within.left; x < within.right; ++x) {
            if (at(canvas, x, y) != background) {
                box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1),
                       std::max(box.bottom, y + 1)};
            }
        }
    }
    return box;
}

std::vector<Pixel> cut_out(Canvas const& canvas, PixelBox const& box) {
    std::vector<Pixel> pixels;
    for (int y = box.top; y < box.bottom; ++y) {
        for (int x = box.left; x < box.right; ++x) {
            pixels.push_back(at(canvas, x, y));
        }
    }
    return pixels;
}

/// The pixels of a text in the ink and the smallest font of pictures.
std::vector<Pixel> written(std::string const& text) {
    Canvas canvas({200, 40});
    canvas.fill(palette::kPaper);
    Text().draw(canvas, text, 11, 20, 10, palette::kInk);
    return cut_out(canvas, box_of_drawn(canvas, canvas.bounds()));
}

Canvas painted_far_away(Snapshot const& snapshot, Camera const& camera, ViewOptions const& options) {
    Canvas canvas(kSize);
    Painter().paint(canvas, camera, snapshot, options);
    return canvas;
}

TEST(ScaleBar, IsAsLongAsItSays) {
    Snapshot const snapshot = snapshot_of(square_world());
    struct Case {
        float scale_px_mm;
        double length_mm;
        char const* label;
    };
    for (auto const& [scale, length_mm, label] :
         {Case{0.38F, 200, "200 mm"}, Case{0.09F, 1000, "1 m"}, Case{0.04F, 2000, "2 m"}, Case{0.0015F, 50000, "50 m"},
          Case{7.0F, 10, "10 mm"}, Case{150.0F, 0.5, "0.5 mm"}}) {
        Camera camera = kFarAway;
        camera.scale_px_mm = scale;
        if (scale < 0.01F) {
            camera.centre_mm = {1e8F, 1e8F};
        }
        Canvas const canvas = painted_far_away(snapshot, camera, {.time = false, .scale_bar = true});
        PixelBox const all = box_of_drawn(canvas, canvas.bounds());
        // The bar, then the label in the middle below it.
        int bar_bottom = all.top;
        while (box_of_drawn(canvas, {0, bar_bottom, 400, bar_bottom + 1}).left < 400) {
            ++bar_bottom;
        }
        PixelBox const bar = box_of_drawn(canvas, {0, all.top, 400, bar_bottom});
        PixelBox const text = box_of_drawn(canvas, {0, bar_bottom, 400, 400});
        EXPECT_NEAR(bar.right - bar.left, length_mm * static_cast<double>(scale), 0.51) << label;
        for (Pixel const pixel : cut_out(canvas, bar)) {
            EXPECT_EQ(pixel, palette::kInk) << label;
        }
        EXPECT_EQ(cut_out(canvas, text), written(label)) << label;
        EXPECT_NEAR(text.left + text.right, bar.left + bar.right, 3) << label;
        EXPECT_LT(all.left, 20) << label;
        EXPECT_GT(all.bottom, 380) << label;
    }
}

TEST(Time, IsWrittenInSecondsWithTwoDigits) {
    Snapshot snapshot = snapshot_of(square_world());
    for (auto const& [time_s, label] :
         {std::pair{0.0, "t = 0.00 s"}, std::pair{12.5, "t = 12.50 s"}, std::pair{1234.567, "t = 1234.57 s"}}) {
        snapshot.time_s = time_s;
        Canvas const canvas = painted_far_away(snapshot, kFarAway, {.time = true, .scale_bar = false});
        PixelBox const text = box_of_drawn(canvas, canvas.bounds());
        EXPECT_EQ(cut_out(canvas, text), written(label));
        EXPECT_GT(text.right, 385);
        EXPECT_LT(text.top, 15);
    }
}

TEST(Time, AndScaleBarLieOnAPlateAboveRobots) {
    World world = square_world();
    add_robot(world, {60, 960});
    add_robot(world, {960, 25});
    world.robots.led[0][0] = world.robots.led[1][0] = kRed;
    Snapshot const snapshot = snapshot_of(world);
    Canvas const without = painted(snapshot);
    Canvas const with = painted(snapshot, {});
    EXPECT_EQ(at_mm(without, {60, 972}), kLitRed);
    EXPECT_GT(at_mm(with, {60, 972}) & 0xFFU, 180U);  // almost white
    EXPECT_EQ(at_mm(without, {945, 12}), kLitRed);
    EXPECT_NE(at_mm(with, {945, 12}), kLitRed);
}

TEST(Robot, HasAMarkFromNearItsMiddleToItsRimAlongItsHeading) {
    for (int i = 0; i < 12; ++i) {
        World world = square_world();
        Vec2 const axis = direction(0.2F + 0.5F * static_cast<float>(i));
        Vec2 const beside{-axis.y, axis.x};
        add_robot(world, {500, 500}, 0.2F + 0.5F * static_cast<float>(i));
        world.robots.led[0][0] = kGreen;
        Canvas const canvas = painted(snapshot_of(world), kNothingWritten, {1600, 1600});
        for (float const along : {8.5F, 13.0F, 18.0F, 24.0F}) {
            EXPECT_EQ(at_mm(canvas, Vec2{500, 500} + along * axis), palette::kEdge) << along;
            EXPECT_EQ(at_mm(canvas, Vec2{500, 500} - along * axis), kLitGreen) << along;
            EXPECT_EQ(at_mm(canvas, Vec2{500, 500} + along * axis + 4.0F * beside), kLitGreen) << along;
            EXPECT_EQ(at_mm(canvas, Vec2{500, 500} + along * axis - 4.0F * beside), kLitGreen) << along;
        }
        EXPECT_EQ(at_mm(canvas, Vec2{500, 500} + 4.0F * axis), kLitGreen);
    }
}

TEST(LateralLed, IsTheInnerHalfOfADiskOnTheRim) {
    for (bool const is_turned : {false, true}) {
        for (std::size_t k = 0; k < 4; ++k) {
            World world = square_world();
            add_robot(world, {500, 500}, 0.3F);
            world.categories[0].spec.robot->rotate_leds_45_deg = is_turned;
            world.robots.led[0][k + 1] = kRed;
            Canvas const canvas = painted(snapshot_of(world), kNothingWritten, {1600, 1600});
            float const quarters = static_cast<float>(k) + (is_turned ? 0.5F : 0.0F);
            Vec2 const outwards = direction(0.3F + quarters * 0.5F * std::numbers::pi_v<float>);
            Vec2 const along{-outwards.y, outwards.x};
            Vec2 const on_rim = Vec2{500, 500} + 26.5F * outwards;
            // A radius of 0.3 of the robot's: 8 mm.
            for (float const angle : {0.2F, 1.0F, 1.6F, 2.2F, 2.9F}) {
                Vec2 const inwards = std::cos(angle) * along - std::sin(angle) * outwards;
                EXPECT_EQ(at_mm(canvas, on_rim + 6.5F * inwards), kLitRed) << k << angle;
                EXPECT_NE(at_mm(canvas, on_rim + 10.0F * inwards), kLitRed) << k << angle;
                EXPECT_NE(at_mm(canvas, on_rim - 3.0F * inwards), kLitRed) << k << angle;
            }
            double const area_px = 0.5 * std::numbers::pi * 7.95 * 7.95 * 1.52 * 1.52;
            EXPECT_NEAR(static_cast<double>(pixels_like(canvas, kLitRed)) / area_px, 0.9, 0.1);
        }
    }
}

TEST(Light, HasItsFirstRowAtTheTopAndItsFirstColumnOnTheLeft) {
    Snapshot snapshot = snapshot_of(square_world());
    ViewOptions options = kNothingWritten;
    options.light_levels = true;
    for (std::size_t lit = 0; lit < 6; ++lit) {
        LightMap map{.columns = 3, .rows = 2, .origin_mm = {0, 0}, .cell_mm = {1000.0F / 3.0F, 500}, .level = {}};
        map.level.assign(6, 0);
        map.level[lit] = 100;
        snapshot.light = std::make_shared<LightMap const>(map);
        Canvas const canvas = painted(snapshot, options);
        for (std::size_t cell = 0; cell < 6; ++cell) {
            Vec2 const centre{1000.0F / 6.0F + static_cast<float>(cell % 3) * 1000.0F / 3.0F,
                              cell < 3 ? 250.0F : 750.0F};
            EXPECT_EQ(at_mm(canvas, centre) > at_mm(canvas, {500, 500}), cell == lit) << lit << cell;
        }
    }
}

TEST(Link, HasTheColourOfTheFirstEmitterOfEachSender) {
    ViewOptions options = kNothingWritten;
    options.links = LinkLayer::above;
    for (std::size_t face = 0; face < kMostFaces; ++face) {
        std::size_t const back = (face + 1) % kMostFaces;
        auto const bit = static_cast<std::uint8_t>(1U << face);
        auto const bit_back = static_cast<std::uint8_t>(1U << back);
        Canvas const both = painted(linked_world(bit, bit_back), options, {1600, 1600});
        for (float const x : {240.0F, 350.0F, 490.0F}) {
            EXPECT_TRUE(looks_like(at_mm(both, {x, 500}), palette::kLinkByEmitter[face])) << face;
            EXPECT_TRUE(looks_like(at_mm(both, {1000 - x, 500}), palette::kLinkByEmitter[back])) << face;
        }
        Canvas const one_way = painted(linked_world(bit, 0), options, {1600, 1600});
        EXPECT_TRUE(looks_like(at_mm(one_way, {350, 500}), palette::kLinkByEmitter[face])) << face;
        EXPECT_TRUE(looks_like(at_mm(one_way, {768, 500}), palette::kLinkByEmitter[face])) << face;
    }
}

TEST(Link, OfOneWayHasItsArrowHeadAtTheListenerAlone) {
    ViewOptions options = kNothingWritten;
    options.links = LinkLayer::below;
    Snapshot snapshot = snapshot_of(square_world());
    for (int i = 0; i < 8; ++i) {
        Vec2 const towards = direction(0.1F + 0.8F * static_cast<float>(i));
        Vec2 const beside{-towards.y, towards.x};
        Vec2 const from = Vec2{500, 500} - 200.0F * towards;
        Vec2 const to = Vec2{500, 500} + 200.0F * towards;
        snapshot.links = {{.from = 0, .to = 1, .from_mm = from, .to_mm = to, .emitters = 1}};
        Canvas const canvas = painted(snapshot, options, {1600, 1600});
        for (float const side : {-3.5F, 3.5F}) {  // beyond the line's own width
            EXPECT_TRUE(looks_like(at_mm(canvas, to - 9.0F * towards + side * beside), palette::kLinkByEmitter[0]));
            EXPECT_EQ(at_mm(canvas, to - 16.0F * towards + side * beside), palette::kFloor);
            EXPECT_EQ(at_mm(canvas, from + 9.0F * towards + side * beside), palette::kFloor);
        }
        EXPECT_TRUE(looks_like(at_mm(canvas, to - 3.0F * towards), palette::kLinkByEmitter[0]));
        EXPECT_EQ(at_mm(canvas, to + 3.0F * towards), palette::kFloor);
        EXPECT_EQ(at_mm(canvas, from - 3.0F * towards), palette::kFloor);
    }
}

/// The trail of robot 0, which goes through these places, one after the other.
std::shared_ptr<Trails const> trail_through(World& world, std::vector<Vec2> const& places) {
    Trails trails;
    for (Vec2 const place : places) {
        world.bodies.position_mm[0] = place;
        trails.follow(world);
    }
    return std::make_shared<Trails const>(trails);
}

std::vector<Vec2> line_of_places(Vec2 from_mm, Vec2 step_mm, int count) {
    std::vector<Vec2> places;
    for (int i = 0; i < count; ++i) {
        places.push_back(from_mm + static_cast<float>(i) * step_mm);
    }
    return places;
}

TEST(Trail, FadesAndThinsTowardsItsEnd) {
    World world = square_world();
    add_robot(world, {10, 500});
    world.robots.led[0][0] = kGreen;
    std::vector<Vec2> const places = line_of_places({10, 500}, {2, 0}, 480);
    auto const trails = trail_through(world, places);
    Snapshot snapshot = snapshot_of(world);
    snapshot.trails = trails;
    ViewOptions options = kNothingWritten;
    options.trails = true;
    Canvas const canvas = painted(snapshot, options, {1600, 1600});
    auto const green = [&](float x_mm) { return static_cast<int>(at_mm(canvas, {x_mm, 500}) >> 8U & 0xFFU); };
    auto const width_px = [&](float x_mm) {
        int width = 0;
        for (int y = 780; y < 820; ++y) {
            width += at(canvas, static_cast<int>(800 + (x_mm - 500) * 1.52F), y) != palette::kFloor ? 1 : 0;
        }
        return width;
    };
    EXPECT_GT(green(900), 0x15 + (210 - 0x15) / 2);
    EXPECT_LT(green(100), 0x15 + (210 - 0x15) / 5);
    for (float x = 150; x < 900; x += 100) {
        EXPECT_GT(green(x + 100), green(x)) << x;
    }
    EXPECT_GT(green(20), 0x15);  // its end is still there
    EXPECT_GT(width_px(900), width_px(30));
    EXPECT_LE(width_px(900), 7);
}

TEST(Trail, IsBrokenAtBothSeamsOfAPeriodicArena) {
    World world = square_world();
    add_robot(world, {500, 500});
    world.robots.led[0][0] = kGreen;
    for (Vec2 const step : {Vec2{2, 0}, Vec2{0, 2}, Vec2{-2, 0}, Vec2{0, -2}}) {
        world.periodic = true;
        std::vector<Vec2> places = line_of_places({500, 500}, step, 400);
        for (Vec2& place : places) {
            place = wrapped(world, place);
        }
        auto const trails = trail_through(world, places);
        Snapshot snapshot = snapshot_of(world);
        snapshot.trails = trails;
        ViewOptions options = kNothingWritten;
        options.trails = true;
        Vec2 const ahead = 0.5F * step;
        Canvas const canvas = painted(snapshot, options);
        for (float const along : {100.0F, 300.0F, 480.0F}) {
            EXPECT_NE(at_mm(canvas, Vec2{500, 500} + along * ahead), palette::kFloor);
        }
        EXPECT_NE(at_mm(canvas, Vec2{500, 500} - 480.0F * ahead), palette::kFloor);  // beyond the seam
        EXPECT_EQ(at_mm(canvas, Vec2{500, 500} - 100.0F * ahead), palette::kFloor);  // a line across would show here
    }
}

TEST(Selection, IsARingAroundTheSelectedRobotAndNothingElse) {
    World world = square_world();
    add_robot(world, {300, 300});
    add_robot(world, {700, 600});
    add_robot(world, {780, 600});
    Snapshot const snapshot = snapshot_of(world);
    ViewOptions options = kNothingWritten;
    Canvas const without = painted(snapshot, options, {1600, 1600});
    options.selected_robot = 1;
    Canvas const with = painted(snapshot, options, {1600, 1600});
    Vec2 const centre = fitted(world.arena.bounds, with.size()).to_pixels({700, 600}, with.size());
    float const radius = 26.5F * 1.52F;
    std::set<int> directions;
    for (int y = 0; y < 1600; ++y) {
        for (int x = 0; x < 1600; ++x) {
            if (at(with, x, y) != at(without, x, y)) {
                Vec2 const offset = Vec2{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F} - centre;
                ASSERT_GT(length(offset), radius) << x << ' ' << y;
                ASSERT_LT(length(offset), radius + 18.0F) << x << ' ' << y;
                directions.insert(static_cast<int>(std::floor(std::atan2(offset.y, offset.x) * 10.0F)));
            }
        }
    }
    EXPECT_EQ(directions.size(), 64U);
    EXPECT_GT(pixels_like(with, palette::kSelection), pixels_like(without, palette::kSelection) + 500U);
    EXPECT_GT(pixels_like(with, palette::kSelectionRim), 500U);
}

TEST(Selection, OfAWallOrAMembraneIsALineAlongItsOutline) {
    World world = square_world();
    std::uint32_t const wall = testing::add_wall(world, {{{300, 300}, {500, 300}, {400, 500}}});
    Polygon dots;
    for (int i = 0; i < 40; ++i) {
        dots.push_back(Vec2{700, 700} + 100.0F * direction(0.157F * static_cast<float>(i)));
    }
    std::uint32_t const membrane = testing::add_membrane(world, dots);
    Snapshot snapshot = snapshot_of(world);
    snapshot.heading_rad.resize(snapshot.position_mm.size());
    Vec2 const on_wall[] = {{400, 300}, {450, 400}, {350, 400}};
    ViewOptions options = kNothingWritten;
    options.selected_robot = wall;
    Canvas const wall_selected = painted(snapshot, options, {1600, 1600});
    options.selected_robot = membrane;
    Canvas const membrane_selected = painted(snapshot, options, {1600, 1600});
    for (Vec2 const place : on_wall) {
        EXPECT_EQ(at_mm(wall_selected, place), palette::kSelection);
        EXPECT_NE(at_mm(membrane_selected, place), palette::kSelection);
    }
    for (Vec2 const dot : {dots[0], dots[13], dots[39]}) {
        EXPECT_EQ(at_mm(membrane_selected, dot), palette::kSelection);
        EXPECT_NE(at_mm(wall_selected, dot), palette::kSelection);
    }
}

/// Two robots far apart that hear each other, one between them whose trail crosses their link, and a lamp.
class Layers : public ::testing::Test {
protected:
    void SetUp() override {
        add_robot(world_, {500, 700});
        add_robot(world_, {350, 500});
        world_.robots.led[0][0] = kGreen;
        world_.robots.led[1][0] = kRed;
        snapshot_ = snapshot_of(world_);
        world_.robots.led[0][0] = kRed;  // as long as it moved
        snapshot_.trails = trail_through(world_, line_of_places({500, 300}, {0, 2}, 200));
        snapshot_.links.push_back(
            {.from = 0, .to = 1, .from_mm = {200, 500}, .to_mm = {800, 500}, .emitters = 2, .emitters_back = 2});
        options_.trails = true;
    }

    Canvas paint() const { return painted(snapshot_, options_, {1600, 1600}); }
    void add_lamp(Vec2 centre_mm) { snapshot_.lamps.push_back({.centre_mm = centre_mm, .shape = {}}); }
    static int red(Pixel pixel) { return static_cast<int>(pixel >> 16U & 0xFFU); }
    static int blue(Pixel pixel) { return static_cast<int>(pixel & 0xFFU); }

    World world_ = square_world();
    Snapshot snapshot_;
    ViewOptions options_ = kNothingWritten;
};

constexpr Vec2 kCrossing{500, 500};  // of the link and the trail
constexpr Vec2 kBody{343, 500};      // of a link and a robot, beside its mark

TEST_F(Layers, LinksBelowAreCoveredByTrailsAndRobots) {
    options_.links = LinkLayer::below;
    Canvas const canvas = paint();
    EXPECT_TRUE(looks_like(at_mm(canvas, {650, 500}), palette::kLinkByEmitter[1]));
    EXPECT_EQ(at_mm(canvas, kBody), kLitRed);
    // The trail takes away from the link's blue.
    EXPECT_LT(blue(at_mm(canvas, kCrossing)), blue(at_mm(canvas, {650, 500})) - 30);
}

TEST_F(Layers, LinksAboveCoverTrailsRobotsLampsAndTheSelection) {
    options_.links = LinkLayer::above;
    options_.selected_robot = 1;
    add_lamp({600, 500});
    Canvas const canvas = paint();
    for (Vec2 const place : {kCrossing, kBody, Vec2{350 - 31, 500}, Vec2{600, 500}}) {
        EXPECT_TRUE(looks_like(at_mm(canvas, place), palette::kLinkByEmitter[1])) << place.x;
    }
}

TEST_F(Layers, TrailsAreCoveredByRobotsAndCoverGlows) {
    Canvas const canvas = paint();
    EXPECT_EQ(at_mm(canvas, {500, 690}), kLitGreen);
    EXPECT_GT(red(at_mm(canvas, {500, 650})), red(at_mm(canvas, {550, 700})) + 30);
}

TEST_F(Layers, LampsCoverRobotsAndAreCoveredByTheSelection) {
    add_lamp({350, 500});
    Canvas canvas = paint();
    EXPECT_EQ(at_mm(canvas, {350, 500}), palette::kLamp);
    snapshot_.lamps.clear();
    add_lamp({350 - 31, 500});  // where the ring will be
    canvas = paint();
    EXPECT_EQ(at_mm(canvas, {350 - 31, 500}), palette::kLamp);
    options_.selected_robot = 1;
    EXPECT_EQ(at_mm(paint(), {350 - 31, 500}), palette::kSelection);
}

TEST_F(Layers, RobotsCoverWhatTheyPushAndMembranes) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {520, 500});
    world.robots.led[0][0] = kGreen;
    world.objects[1].robot = kNone;
    Canvas const canvas = painted(snapshot_of(world), kNothingWritten, {1600, 1600});
    EXPECT_EQ(at_mm(canvas, {505, 515}), kLitGreen);  // within both
    EXPECT_EQ(at_mm(canvas, {535, 515}), palette::kNoLed);
}

TEST(Text, HasWidthsThatAddUpAndLetters) {
    Text text;
    EXPECT_EQ(text.width("", 16), 0);
    EXPECT_GT(text.width("mm", 16), text.width("m", 16));
    EXPECT_GT(text.width("m", 32), text.width("m", 16));
    EXPECT_EQ(text.width("\xC3\xA9", 16), text.width("e", 16));  // é
    Canvas canvas({40, 20});
    text.draw(canvas, "t", 16, 4, 2, 0xFFFFFFFF);
    EXPECT_GT(std::count_if(canvas.pixels().begin(), canvas.pixels().end(), [](Pixel p) { return (p & 0xFFU) > 100U; }),
              8);
}

TEST(Text, OfBrokenUtf8IsDrawnWithQuestionMarks) {
    Text text;
    int const question = text.width("?", 16);
    for (char const* const broken : {"\xC3", "\x80", "\xFF", "\xE2\x82\xAC", "\xC0"}) {
        EXPECT_EQ(text.width(broken, 16), question);
    }
    Canvas canvas({40, 20});
    text.draw(canvas, "\xF0\x9F\x98\x80\xC3", 16, -3, 10, 0xFFFFFFFF);
}

}  // namespace
}  // namespace pogosim
