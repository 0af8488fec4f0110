// Categories that say themselves where their objects start.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "config/config_file.hpp"
#include "lamps/lamp_types.hpp"
#include "physics/physics_engine.hpp"
#include "sim/build_world.hpp"

namespace pogosim {
namespace {

using config_file::error_of;
using config_file::Folder;
using config_file::Warnings;

std::string const kScene =
    "arena_file: arena.csv\n"
    "arena_surface: 1e6\n"
    "initial_formation: random\n"
    "objects:\n"
    "  robots: {type: pogobot, geometry: disk, radius: 20, nb: 20}\n";

constexpr char const* kSquare = "0,0\n1,0\n1,1\n0,1\n";
/// A right triangle: half of the square, the legs along its left and upper side.
constexpr char const* kTriangle = "0,0\n1,0\n0,1\n";

struct Built {
    World world;
    std::string error = "no error";
    std::vector<std::string> warnings;

    /// Objects of a category, by name.
    std::vector<Object> of(std::string const& category) const {
        std::vector<Object> found;
        for (Object const& object : world.objects) {
            if (world.categories[object.category].name == category) {
                found.push_back(object);
            }
        }
        return found;
    }
    Vec2 place(Object const& object) const { return world.bodies.position_mm[object.body]; }
    float heading(Object const& object) const { return world.bodies.heading_rad[object.body]; }
};

Built build(std::string const& objects, char const* arena = kSquare, std::string const& before = kScene) {
    Folder const folder;
    Warnings const warnings;
    Folder::write("arena.csv", arena);
    Folder::write("poses.csv", "x,y\n100,100\n200,100\n300,100\n400,100\n");
    Folder::write("x.yaml", before + objects);
    Built built;
    built.error = error_of([&] { built.world = build_world(load_scenario("x.yaml", {}, object_types()), 1); });
    built.warnings = warnings.lines();
    return built;
}

TEST(Placement, AngleStandsBesideXAndY) {
    Built const built = build("  it: {type: passive_object, geometry: disk, x: 300, y: 400, angle: 1.5}\n");
    ASSERT_EQ(built.error, "no error");
    Object const it = built.of("it").front();
    EXPECT_EQ(built.place(it), (Vec2{300, 400}));
    EXPECT_FLOAT_EQ(built.heading(it), 1.5F);
}

TEST(Placement, PosesStandInTheOrderOfTheListAndSayHowManyThereAre) {
    Built const built = build("  it: {type: pogobot, geometry: disk, poses: [[300, 400], [500, 600, -1]]}\n");
    ASSERT_EQ(built.error, "no error");
    std::vector<Object> const it = built.of("it");
    ASSERT_EQ(it.size(), 2U);
    EXPECT_EQ(built.place(it[0]), (Vec2{300, 400}));
    EXPECT_FLOAT_EQ(built.heading(it[0]), 0.0F);
    EXPECT_EQ(built.place(it[1]), (Vec2{500, 600}));
    EXPECT_FLOAT_EQ(built.heading(it[1]), -1.0F);
}

TEST(Placement, AreaHoldsItsCategoryAndTheOthersKeepOffIt) {
    for (char const* const formation : {"random", "disk", "lloyd", "power_lloyd"}) {
        Built const built =
            build(std::string("  it: {type: pogobot, geometry: disk, radius: 10, nb: 6, "
                              "area: {x: 800, y: 300, radius: 100}, initial_formation: ") +
                  formation + "}\n" +
                  "  bars: {type: passive_object, geometry: rectangle, body_width: 80, body_height: 20, "
                  "nb: 3, area: [[0, 500], [400, 500], [400, 1000], [0, 1000]]}\n");
        ASSERT_EQ(built.error, "no error") << formation;
        ASSERT_EQ(built.of("it").size(), 6U);
        for (Object const& it : built.of("it")) {
            EXPECT_LE(length(built.place(it) - Vec2{800, 300}), 90.0F) << formation;
        }
        for (Object const& bar : built.of("bars")) {
            EXPECT_LE(built.place(bar).x, 400.0F);
            EXPECT_GE(built.place(bar).y, 500.0F);
        }
        for (Object const& robot : built.of("robots")) {
            for (Object const& it : built.of("it")) {
                EXPECT_GE(length(built.place(robot) - built.place(it)), 30.0F) << formation;
            }
        }
    }
}

TEST(Placement, AreaIsWhatTheArenaHasOfIt) {
    // The arena is a triangle with legs of 1414 mm; the area is a square around the middle of its long side.
    for (char const* const arena : {kTriangle, "0,0\n0,1\n1,0\n"}) {
        Built const built = build(
            "  it: {type: pogobot, geometry: disk, radius: 10, nb: 30, initial_formation: random, "
            "area: [[500, 500], [900, 500], [900, 900], [500, 900]]}\n",
            arena);
        ASSERT_EQ(built.error, "no error");
        for (Object const& it : built.of("it")) {
            Vec2 const place = built.place(it);
            EXPECT_TRUE(built.world.arena.contains(place));
            EXPECT_GE(built.world.arena.distance_to_walls(place), 10.0F);
            EXPECT_GE(std::min(place.x, place.y), 510.0F);
        }
    }
}

TEST(Placement, AreaAroundAHoleOfTheArenaIsFreeBesideTheHoleOnly) {
    Built const built = build(
        "  it: {type: pogobot, geometry: disk, radius: 10, nb: 60, initial_formation: random, "
        "area: [[250, 250], [850, 250], [850, 850], [250, 850]]}\n",
        "0,0\n1,0\n1,1\n0,1\n\n0.3,0.3\n0.7,0.3\n0.7,0.7\n0.3,0.7\n");
    ASSERT_EQ(built.error, "no error");
    for (Object const& it : built.of("it")) {
        EXPECT_TRUE(built.world.arena.contains(built.place(it)));
        EXPECT_GE(built.world.arena.distance_to_walls(built.place(it)), 10.0F);
    }
}

TEST(Placement, FormationAroundACentreStandsAroundThatOfItsArea) {
    // Not around that of the other robots' formation.
    std::string with_disk = kScene;
    with_disk.replace(with_disk.find("random"), 6, "disk");
    Built const built = build(
        "  it: {type: pogobot, geometry: disk, radius: 10, nb: 7, initial_formation: disk, "
        "area: {x: 700, y: 300, radius: 200}}\n",
        kSquare, "initial_formation_center: [400, 600]\n" + with_disk);
    ASSERT_EQ(built.error, "no error");
    Vec2 sum;
    for (Object const& it : built.of("it")) {
        sum = sum + built.place(it);
    }
    EXPECT_LT(length((1.0F / 7.0F) * sum - Vec2{700, 300}), 20.0F);
}

TEST(Placement, LampThatReachesBeyondTheWallsHoldsNoRobotThere) {
    Built const built = build("  light: {type: static_light, geometry: disk, radius: 400, x: 950, y: 500}\n", kSquare,
                              "initial_formation_root_object: light\n" + kScene);
    EXPECT_NE(built.error.find("'light' reaches beyond the arena"), std::string::npos) << built.error;
}

TEST(Placement, SmallObjectDeepInALargeOneIsWarnedOf) {
    // Fixed disks of 10 and 200 mm; the small one is 12 mm deep in the large one.
    Built const built = build(
        "  big: {type: passive_object, geometry: disk, radius: 200, x: 500, y: 500}\n"
        "  small: {type: passive_object, geometry: disk, radius: 10, x: 698, y: 500}\n");
    ASSERT_EQ(built.error, "no error");
    ASSERT_EQ(built.warnings.size(), 1U);
    EXPECT_NE(built.warnings[0].find("by 12.0 mm"), std::string::npos) << built.warnings[0];
}

TEST(Placement, SaysWhatIsWrongWhere) {
    struct Case {
        char const* keys;
        char const* message;
    };
    Case const cases[] = {
        {"angle: 1", ".angle: angle without x and y; it is the heading of objects placed at x and y"},
        {"nb: 3, poses: [[1, 2]]", ".nb: expected 1, the number of poses, found 3; nb may be omitted"},
        {"poses: []", ".poses: the list is empty; specify one pose per object, or omit the key"},
        {"poses: [[500, 500], [1]]", ".poses.1: expected [x, y] or [x, y, angle] (mm, rad), found a list of 1"},
        {"poses: [[500, 5000]]",
         ".poses: (500, 5000) is outside the arena, which extends from (0.0, 0.0) to (1000.0, 1000.0) mm"},
        {"x: 1, y: 2, poses: [[1, 2]]", ".poses: cannot be combined with 'x'; use one or the other"},
        {"x: 1, poses: [[1, 2]]", ".poses: cannot be combined with 'x'; use one or the other"},
        {"y: 2, poses: [[1, 2]]", ".poses: cannot be combined with 'y'; use one or the other"},
        {"x: 1, y: 2, area: {x: 1, y: 1, radius: 5}", ".area: cannot be combined with 'x'; use one or the other"},
        {"area: {x: 500, y: 500, radius: -5}",
         ".area.radius: expected a number above 0, at most 1000000 (mm), found -5"},
        {"area: [[0, 0], [10, 10], [10, 0], [0, 10]]", ".area: these corners enclose no area"},
        {"area: [[0, 0], [10, 10], [20, 0], [0, 12]]",
         ".area: the sides of this polygon cross or touch each other; list its corners in order, each once"},
        {"body_fixed: true",
         ".body_fixed: a robot with wheels cannot be fixed; use a passive_object, an active_object or a "
         "pogobject"},
    };
    for (Case const& one : cases) {
        EXPECT_EQ(build(std::string("  it: {type: pogobot, geometry: disk, ") + one.keys + "}\n").error,
                  std::string("x.yaml:6: objects.it") + one.message);
    }
    std::string const small = "  it: {type: pogobot, geometry: disk, nb: 50, area: {x: 500, y: 500, radius: 50}}\n";
    EXPECT_EQ(build(small).error.find("x.yaml:6: objects.it.area: initial_formation: 'random' cannot place 50 objects"),
              0U)
        << build(small).error;
    EXPECT_TRUE(build(small).error.ends_with("reduce nb or enlarge the area")) << build(small).error;
    std::string const away = "  it: {type: pogobot, geometry: disk, area: {x: 5000, y: 500, radius: 50}}\n";
    EXPECT_EQ(build(away).error,
              "x.yaml:6: objects.it.area: it lies entirely outside the arena, which extends from (0.0, 0.0) to "
              "(1000.0, 1000.0) mm");
}

TEST(Placement, RowsOfAFileGoToTheCategoriesInTheirOrderAndRowsTooManyAreSaid) {
    std::string const imported =
        "arena_file: arena.csv\narena_surface: 1e6\ninitial_formation: imported\nformation_filename: poses.csv\n"
        "objects:\n";
    std::string const objects =
        "  b: {type: pogobot, geometry: disk}\n"
        "  fixed: {type: pogobot, geometry: disk, x: 800, y: 800}\n"
        "  a: {type: pogobot, geometry: disk, nb: 2}\n";
    Built const built = build(objects, kSquare, imported);
    ASSERT_EQ(built.error, "no error");
    EXPECT_EQ(built.place(built.of("b")[0]), (Vec2{100, 100}));
    EXPECT_EQ(built.place(built.of("a")[0]), (Vec2{200, 100}));
    EXPECT_EQ(built.place(built.of("a")[1]), (Vec2{300, 100}));
    ASSERT_EQ(built.warnings.size(), 1U);
    EXPECT_NE(
        built.warnings[0].find("has 4 poses (rows with the first time value) for 3 objects; the last 1 is ignored"),
        std::string::npos)
        << built.warnings[0];
}

namespace {

std::string const kImported =
    "arena_file: arena.csv\narena_surface: 1e6\ninitial_formation: imported\nformation_filename: poses.csv\n"
    "objects:\n";

Built build_imported(std::string const& poses, std::string const& before = kImported, std::string const& more = "") {
    Folder const folder;
    Warnings const warnings;
    auto const count = static_cast<int>(std::ranges::count(poses, '\n'));
    Folder::write("arena.csv", kSquare);
    Folder::write("poses.csv", poses);
    Folder::write("x.yaml",
                  before + fmt::format("  it: {{type: pogobot, geometry: disk, radius: 25, nb: {}}}\n", count) + more);
    Built built;
    built.error = error_of([&] { built.world = build_world(load_scenario("x.yaml", {}, object_types()), 1); });
    built.warnings = warnings.lines();
    return built;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST(ImportedObjects, ThatOverlapAreOneWarningWithTheFirstPair) {
    EXPECT_EQ(build_imported("100,100\n200,100\n250,100\n").warnings, Lines{});
    EXPECT_EQ(build_imported("100,100\n200,100\n249.5,100\n").warnings, Lines{});  // a run may leave that
    EXPECT_EQ(build_imported("100,100\n200,100\n240,100\n").warnings,
              Lines{"poses.csv: two objects overlap: it 1 at (200, 100) and it 2 at (240, 100) mm by 10.0 mm; physics "
                    "pushes them apart"});
    EXPECT_EQ(build_imported("100,500\n800,100\n820,100\n840,100\n").warnings,
              Lines{"poses.csv: 3 pairs of objects overlap: first it 1 at (800, 100) and it 2 at (820, 100) mm by 30.0 "
                    "mm; physics pushes them apart"});
}

TEST(ImportedObjects, ThatAllOverlapMayBeInAnotherUnit) {
    Lines const warnings = build_imported("300,300\n310,300\n300,310\n").warnings;
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("3 pairs of objects overlap"), std::string::npos);
    EXPECT_NE(warnings[0].find("All objects do: if the file is not in mm, imported_formation_min_coords"),
              std::string::npos);
}

TEST(ImportedObjects, ThatReachIntoAWallAreOneWarning) {
    EXPECT_EQ(build_imported("24.5,100\n500,500\n").warnings, Lines{});
    EXPECT_EQ(
        build_imported("10,100\n500,500\n").warnings,
        Lines{"poses.csv: an object reaches into a wall: it 0 at (10, 100) mm by 15.0 mm; physics pushes it out"});
    EXPECT_EQ(
        build_imported("500,500\n10,100\n500,980\n").warnings,
        Lines{"poses.csv: 2 objects reach into a wall: first it 1 at (10, 100) mm by 15.0 mm; physics pushes them "
              "out"});
}

TEST(ImportedObjects, ThatOverlapAFixedOneAreNamedWithIt) {
    EXPECT_EQ(
        build_imported("100,100\n500,500\n", kImported,
                       "  box: {type: passive_object, geometry: rectangle, body_width: 100, body_height: 100, x: 560, "
                       "y: 500}\n")
            .warnings,
        Lines{"poses.csv: two objects overlap: it 1 at (500, 500) and box 65535 at (560, 500) mm by 15.0 mm; "
              "physics pushes them apart"});
}

TEST(ImportedObjects, ThatAreSmallMayOverlapByATenthOfTheirRadius) {
    auto const warnings_of_two_beads = [](char const* x) {
        Folder const folder;
        Warnings const warnings;
        Folder::write("arena.csv", kSquare);
        Folder::write("poses.csv", fmt::format("500,500\n100,100\n{},100\n", x));
        Folder::write("x.yaml", kImported +
                                    "  it: {type: pogobot, geometry: disk, radius: 25, nb: 1}\n"
                                    "  bead: {type: passive_object, geometry: disk, radius: 2, nb: 2}\n");
        EXPECT_EQ(error_of([] { build_world(load_scenario("x.yaml", {}, object_types()), 1); }), "no error");
        return warnings.lines();
    };
    EXPECT_EQ(warnings_of_two_beads("103.85"), Lines{});
    Lines const warnings = warnings_of_two_beads("103.7");
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("mm by 0.3 mm; physics pushes them apart"), std::string::npos) << warnings[0];
}

TEST(Overlaps, AcrossTheSeamOfAPeriodicArenaAreSeen) {
    std::string const periodic = "boundary_condition: periodic\n";
    EXPECT_EQ(build_imported("5,500\n990,500\n", periodic + kImported).warnings,
              Lines{"poses.csv: two objects overlap: it 0 at (5, 500) and it 1 at (990, 500) mm by 35.0 mm; physics "
                    "pushes them apart. All objects do: if the file is not in mm, imported_formation_min_coords and "
                    "imported_formation_max_coords say which of its coordinates are the arena's corners"});
    EXPECT_EQ(build_imported("5,5\n965,965\n", periodic + kImported).warnings, Lines{});  // 57 mm across the corner
    EXPECT_EQ(build_imported("5,5\n975,975\n", periodic + kImported).warnings.size(), 1U);
    std::string const scene = periodic + kScene;
    Built const fixed = build(
        "  a: {type: passive_object, geometry: disk, radius: 30, x: 10, y: 500}\n"
        "  b: {type: passive_object, geometry: disk, radius: 30, x: 980, y: 500}\n",
        kSquare, scene);
    EXPECT_EQ(fixed.warnings, Lines{"x.yaml:8: objects.b.x: 'b' at (980, 500) overlaps 'a' by 30.0 mm"});
}

TEST(Overlaps, AcrossTheSeamAreSeenWhicheverOfTheTwoCrossesIt) {
    std::string const scene = "boundary_condition: periodic\n" + kScene;
    std::string const crossing = ": {type: passive_object, geometry: disk, radius: 30, x: 10, y: 500}\n";
    std::string const inside = ": {type: passive_object, geometry: disk, radius: 30, x: 960, y: 500}\n";
    EXPECT_EQ(build("  a" + crossing + "  b" + inside, kSquare, scene).warnings,
              Lines{"x.yaml:8: objects.b.x: 'b' at (960, 500) overlaps 'a' by 10.0 mm"});
    EXPECT_EQ(build("  a" + inside + "  b" + crossing, kSquare, scene).warnings,
              Lines{"x.yaml:8: objects.b.x: 'b' at (10, 500) overlaps 'a' by 10.0 mm"});
}

TEST(Overlaps, AcrossTheSeamAreAvoidedByEveryFormation) {
    std::string const pillar =
        "  pillar: {type: passive_object, geometry: disk, radius: 150, x: 10, y: 20, body_fixed: true}\n";
    std::string const bar =
        "  bar: {type: passive_object, geometry: rectangle, body_width: 300, body_height: 60, x: 500, y: 985}\n";
    for (std::string const& formation : formation_names()) {
        if (formation == "imported") {
            continue;
        }
        std::string const scene =
            "arena_file: arena.csv\narena_surface: 1e6\nboundary_condition: periodic\n"
            "initial_formation: " +
            formation + "\nformation_cluster_at_center: false\nobjects:\n";
        std::string const robots = "{type: pogobot, geometry: disk, radius: 20, nb: 40";
        for (std::string const& own : {std::string("}\n"), ", initial_formation: " + formation + "}\n",
                                       std::string(", area: [[0, 0], [1000, 0], [1000, 1000], [0, 1000]]}\n")}) {
            Built const built = build("  it: " + robots + own + pillar + bar, kSquare, scene);
            ASSERT_EQ(built.error, "no error") << formation << own;
            for (Object const& it : built.of("it")) {
                Vec2 const place = built.place(it);
                EXPECT_GE(length(minimum_image(built.world, {10, 20}, place)), 170.0F) << formation << own;
                Vec2 const to_bar = minimum_image(built.world, {500, 985}, place);
                Vec2 const beyond{std::max(std::abs(to_bar.x) - 150.0F, 0.0F),
                                  std::max(std::abs(to_bar.y) - 30.0F, 0.0F)};
                EXPECT_GE(length(beyond), 20.0F) << formation << own;
            }
        }
    }
}

TEST(FixedBody, StaysWhereItIsWhateverHitsIt) {
    Built built = build(
        "  it: {type: passive_object, geometry: rectangle, body_width: 50, body_height: 300, x: 500, y: 500, "
        "angle: 0.5, body_fixed: true}\n"
        "  light: {type: pogobject, geometry: disk, radius: 30, x: 800, y: 500, body_fixed: true}\n");
    ASSERT_EQ(built.error, "no error");
    World& world = built.world;
    WorkerPool workers;
    auto const engine = make_box2d_engine(world, {}, workers);
    for (int step = 0; step < 300; ++step) {
        for (Object const& robot : built.of("robots")) {
            Vec2 const way = Vec2{500, 500} - built.place(robot);
            world.robots.command[robot.robot] = {.velocity_mm_s = (2000.0F / std::max(length(way), 1.0F)) * way,
                                                 .pending = true};
        }
        engine->advance(world);
    }
    EXPECT_EQ(built.place(built.of("it")[0]), (Vec2{500, 500}));
    EXPECT_EQ(built.heading(built.of("it")[0]), 0.5F);
    EXPECT_EQ(built.place(built.of("light")[0]), (Vec2{800, 500}));
}

}  // namespace
}  // namespace pogosim
