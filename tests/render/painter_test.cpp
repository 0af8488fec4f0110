#include "render/painter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

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
constexpr PaintOptions kNothingWritten{.time = false, .scale_bar = false};
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

Canvas painted(Snapshot const& snapshot, PaintOptions const& options = kNothingWritten, PictureSize size = kSize) {
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
        PaintOptions without = kNothingWritten;
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
    spec.ring.emplace();
    spec.ring->radius_mm = 10.0F;
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
    PaintOptions options = kNothingWritten;
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
    PaintOptions options = kNothingWritten;
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

TEST(Link, HasTheColourOfEachSendersEmitterOnItsHalf) {
    for (LinkLayer const layer : {LinkLayer::below, LinkLayer::above}) {
        PaintOptions options = kNothingWritten;
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
    PaintOptions options = kNothingWritten;
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
    PaintOptions options = kNothingWritten;
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
    PaintOptions options = kNothingWritten;
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
    PaintOptions options = kNothingWritten;
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
    PaintOptions options = kNothingWritten;
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
        PaintOptions options;
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
        PaintOptions options{.links = LinkLayer::above, .light_levels = true, .trails = true, .selected_robot = 1};
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
    auto const changed_in = [&](PaintOptions const& options) {
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
