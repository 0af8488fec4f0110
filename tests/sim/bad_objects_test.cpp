// Objects that cannot be made or do not fit: one message that names file, line, object and key.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_file.hpp"
#include "lamps/lamp_types.hpp"
#include "sim/build_world.hpp"
#include "sim/simulation.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using config_file::error_of;
using config_file::Folder;
using config_file::Warnings;

/// A square of 1 m with a robot, lines 1 to 7, and then objects of the test.
std::string const kScene =
    "arena_file: square.csv\n"
    "arena_surface: 1e6\n"
    "initial_formation: random\n"
    "ROOT\n"
    "objects:\n"
    "  robots: {type: pogobot, geometry: disk, radius: 26.5}\n";

/// The message for a configuration with these objects, "no error" when it can be simulated.
std::string error_with(std::string const& objects, std::string const& root = "",
                       std::string const& outline = "0,0\n1,0\n1,1\n0,1\n") {
    Folder const folder;
    Warnings const warnings;
    Folder::write("square.csv", outline);
    std::string text = kScene;
    text.replace(text.find("ROOT"), 4, root.empty() ? "" : "initial_formation_root_object: " + root);
    Folder::write("x.yaml", text + objects);
    return error_of([] { build_world(load_scenario("x.yaml", {}, object_types()), 1); });
}

struct Case {
    char const* keys;
    char const* message;  // behind "x.yaml:7: objects.it."
};

void expect_refused(std::string const& type, std::vector<Case> const& cases) {
    for (Case const& one : cases) {
        EXPECT_EQ(error_with("  it: {type: " + type + ", " + one.keys + "}\n"),
                  std::string("x.yaml:7: objects.it") + one.message)
            << type;
    }
}

TEST(BadObjects, NegativeAndZeroSizesAndMasses) {
    for (char const* const type :
         {"pogobot", "pogobject", "membrane", "rectmembrane", "active_object", "passive_object"}) {
        bool const is_ring = std::string_view(type).ends_with("membrane");
        std::string const shapes =
            std::string(".geometry: expected one of disk, rectangle, capsule, triangle, polygon") +
            (is_ring ? "" : ", compound");
        std::string const blob = shapes + ", found 'blob'";
        std::string const arena = shapes + ", found 'arena'";
        expect_refused(
            type, {{"geometry: disk, radius: 0", ".radius: expected a number from 0.001 to 1000000 (mm), found 0"},
                   {"geometry: disk, radius: -5", ".radius: expected a number from 0.001 to 1000000 (mm), found -5"},
                   {"geometry: disk, body_density: -1",
                    ".body_density: expected a number from 0 to 1000000000000000 (kg per (100 mm)^2), found -1"},
                   {"geometry: blob", blob.c_str()},
                   {"geometry: arena", arena.c_str()},
                   {"geometry: disk, x: 4", ".x: x without y; specify both or neither"}});
    }
}

TEST(BadObjects, MembranesWithoutDots) {
    for (char const* const type : {"membrane", "rectmembrane"}) {
        expect_refused(
            type,
            {{"geometry: disk, num_dots: 0", ".num_dots: expected an integer from 3 to 10000, found 0"},
             {"geometry: disk, num_dots: -3", ".num_dots: expected an integer from 3 to 10000, found -3"},
             {"geometry: disk, dot_radius: 0", ".dot_radius: expected a number from 0.001 to 1000000 (mm), found 0"},
             {"geometry: disk, stiffness: 0", ".stiffness: expected a number above 0, at most 10000 (Hz), found 0"},
             {"geometry: disk, cross_span: -1", ".cross_span: expected an integer from 0 to 10000 (dots), found -1"},
             {"geometry: disk, colormap: blue", ".colormap: expected rainbow or qualitative, found 'blue'"}});
    }
}

TEST(BadObjects, RingsThatCannotBe) {
    expect_refused("membrane", {{"geometry: disk, radius: 100, dot_radius: 150",
                                 ".dot_radius: the membrane is too thick for a shape of radius 100 mm"},
                                {"geometry: disk, radius: 100, num_dots: 9000",
                                 ".num_dots: that many would be only 0.063 mm apart; the minimum is 0.1 mm"}});
    expect_refused("rectmembrane", {{"geometry: disk, radius: 100, rect_thickness: 201",
                                     ".rect_thickness: the membrane is too thick for a shape of radius 100 mm"},
                                    {"geometry: disk, rect_thickness: 0",
                                     ".rect_thickness: expected a number from 0.001 to 1000000 (mm), found 0"}});
    EXPECT_EQ(error_with("  it: {type: membrane, geometry: disk}\n"), "no error");  // all defaults
}

std::string const kArena = "the arena, which extends from (0.0, 0.0) to (1000.0, 1000.0) mm";

TEST(BadObjects, WhatMaySlipThroughAMembraneIsNamedIfThereIsAny) {
    std::string const membrane = "  it: {type: membrane, geometry: disk, radius: 60, num_dots: 5}\n";
    for (int const nb : {0, 1}) {
        Folder const folder;
        Folder::write("square.csv", "0,0\n1,0\n1,1\n0,1\n");
        std::string text = kScene;
        text.replace(text.find("ROOT"), 4, "");
        Folder::write("x.yaml", text + membrane +
                                    "  pea: {type: passive_object, geometry: disk, nb: " + std::to_string(nb) + "}\n");
        Warnings const warnings;
        build_world(load_scenario("x.yaml", {}, object_types()), 1);
        EXPECT_EQ(warnings.text().find("'pea' may slip through") != std::string::npos, nb == 1) << warnings.text();
    }
}

TEST(BadObjects, LargerThanTheArena) {
    for (char const* const type : {"membrane", "rectmembrane", "passive_object", "active_object", "pogobject"}) {
        for (char const* const place : {"", ", x: 500, y: 500"}) {
            std::string const before = std::string("  it: {type: ") + type + place;
            EXPECT_EQ(error_with(before + ", geometry: disk, radius: 600}\n"),
                      "x.yaml:7: objects.it.radius: the object is 1200.0 mm across, too large for " + kArena);
        }
    }
    EXPECT_EQ(error_with("  it: {type: membrane, geometry: rectangle, body_width: 1200, body_height: 50}\n"),
              "x.yaml:7: objects.it.body_width: the object is 1201.0 mm across, too large for " + kArena);
    EXPECT_EQ(error_with("  it: {type: passive_object, geometry: rectangle, body_height: 1200}\n"),
              "x.yaml:7: objects.it.body_height: the object is 1200.0 mm across, too large for " + kArena);
    EXPECT_EQ(error_with("  it: {type: membrane, geometry: triangle, side_length: 1000}\n"),
              "x.yaml:7: objects.it.side_length: the object is 1154.7 mm across, too large for " + kArena);
    EXPECT_EQ(error_with("  it: {type: membrane, geometry: disk, radius: 200, x: 900, y: 500}\n"),
              "x.yaml:7: objects.it.radius: around (900, 500) the object reaches beyond " + kArena);
}

TEST(BadObjects, BeyondTheWallsThoughInsideOfTheBox) {
    EXPECT_EQ(
        error_with("  it: {type: passive_object, geometry: disk, x: 20, y: 20}\n", "", "5,0\n10,5\n5,10\n0,5\n"),
        "x.yaml:7: objects.it.x: (20, 20) is beyond the walls of the arena, which extends from (0.0, 0.0) to (1414.2, "
        "1414.2) mm");
}

TEST(BadObjects, OutsideOfTheArena) {
    for (char const* const type :
         {"pogobot", "pogobject", "pogowall", "membrane", "rectmembrane", "active_object", "passive_object"}) {
        EXPECT_EQ(error_with(std::string("  it: {type: ") + type + ", geometry: disk, x: 1300, y: -2}\n"),
                  "x.yaml:7: objects.it.x: (1300, -2) is outside " + kArena);
        EXPECT_EQ(error_with(std::string("  it: {type: ") + type + ", geometry: disk, x: 500,\n    y: 1300}\n"),
                  "x.yaml:8: objects.it.y: (500, 1300) is outside " + kArena);
    }
}

TEST(BadObjects, WallsOfAShapeNeedAPlace) {
    for (char const* const shape : {"disk", "rectangle", "triangle"}) {
        EXPECT_EQ(error_with(std::string("  it: {type: pogowall, geometry: ") + shape + "}\n"),
                  "x.yaml:7: objects.it: needs x and y: no formation places a wall of this geometry");
    }
    expect_refused("pogowall",
                   {{"geometry: global",
                     ".geometry: expected one of arena, disk, rectangle, capsule, triangle, polygon, found 'global'"}});
    EXPECT_EQ(error_with("  it: {type: pogowall, geometry: arena}\n"), "no error");
    EXPECT_EQ(error_with("  it: {type: pogowall, geometry: arena, x: 3, y: 4000}\n"), "no error");  // stays where it is
}

TEST(BadObjects, FormationsInsideOfSomethingThatIsNoSpace) {
    std::string const membrane = "  it: {type: membrane, geometry: disk, radius: 150";
    std::string const key = "x.yaml:4: initial_formation_root_object: ";
    EXPECT_EQ(error_with(membrane + "}\n", "it"), "no error");
    EXPECT_EQ(error_with(membrane + "}\n", "nobody"),
              key + "expected 'arena' or a category of 'objects', found 'nobody'");
    EXPECT_EQ(error_with(membrane + ", nb: 0}\n", "it"),
              key + "'it' has no objects; use the arena, a wall, a membrane or a lamp");
    EXPECT_EQ(error_with("  it: {type: passive_object, geometry: disk, radius: 150}\n", "it"),
              key + "'it' is solid, so nothing fits inside; use the arena, a wall, a membrane or a lamp");
    EXPECT_EQ(
        error_with(membrane + ", dot_radius: 90}\n", "it"),
        key + "the membrane of 'it' is so thick that it leaves no space inside; enlarge x.yaml:7: objects.it.radius");
    std::string const narrow = error_with(membrane + ", dot_radius: 65}\n", "it");
    EXPECT_TRUE(narrow.starts_with("x.yaml:3: initial_formation: 'random' cannot place 1 object ")) << narrow;
    EXPECT_TRUE(narrow.ends_with(" (inside 'it': x.yaml:4: initial_formation_root_object)")) << narrow;
}

TEST(BadObjects, FormationsThatHaveNoRoomNameTheirLineAndTheSizes) {
    std::string const many = error_with("  discs: {type: passive_object, nb: 90, geometry: disk, radius: 60}\n");
    EXPECT_TRUE(many.starts_with("x.yaml:3: initial_formation: 'random' cannot place 91 objects ")) << many;
    EXPECT_TRUE(many.ends_with(". Radii: robots (1) 26.5 mm, discs (90) 60 mm")) << many;
}

TEST(BadArenas, TooSmallForWalls) {
    Folder const folder;
    Warnings const warnings;
    Folder::write("square.csv", "0,0\n1,0\n1,1\n0,1\n");
    Folder::write(
        "x.yaml",
        "arena_file: square.csv\narena_surface: 0.5\nphysics_engine: box2d\nobjects:\n  lamp: {type: static_light, "
        "geometry: global}\n");
    EXPECT_EQ(error_of([] {
                  Simulation const simulation(testing::test_program(), load_scenario("x.yaml", {}, object_types()), {});
              }),
              "x.yaml:2: arena_surface: the arena is too small to build walls: its corners lie less than 1 mm apart; "
              "enlarge it");
}

TEST(MissingFiles, OnlyArenasAreOfferedArenas) {
    Folder const folder;
    Warnings const warnings;
    std::string const head = "initial_formation: imported\nformation_filename: poses.csv\narena_file: square.csv\n";
    Folder::write("x.yaml", head + "objects:\n  robots: {type: pogobot, geometry: disk}\n");
    auto const message = [] { return error_of([] { build_world(load_scenario("x.yaml", {}, object_types()), 1); }); };
    EXPECT_EQ(message().find("x.yaml:3: arena_file: there is no file 'square.csv'; searched "), 0U) << message();
    EXPECT_NE(message().find("Bundled arenas"), std::string::npos) << message();
    Folder::write("square.csv", "0,0\n1,0\n1,1\n0,1\n");
    EXPECT_EQ(message().find("x.yaml:2: formation_filename: there is no file 'poses.csv'; searched "), 0U) << message();
    EXPECT_EQ(message().find("Bundled arenas"), std::string::npos) << message();
}

TEST(MissingFiles, FoldersInTheirPlaceAreRefusedWithTheirLine) {
    Folder const folder;
    Warnings const warnings;
    std::string const robots = "objects:\n  robots: {type: pogobot, geometry: disk}\n";
    auto const message = [&](std::string const& head) {
        Folder::write("x.yaml", head + robots);
        return error_of([] { build_world(load_scenario("x.yaml", {}, object_types()), 1); });
    };
    std::filesystem::create_directory("shapes.csv");
    EXPECT_EQ(message("seed: 1\narena_file: shapes.csv\n"),
              "x.yaml:2: arena_file: 'shapes.csv' is a folder; expected a file");
    EXPECT_EQ(message("arena_file: arenas/disk.csv\ninitial_formation: imported\nformation_filename: shapes.csv\n"),
              "x.yaml:3: formation_filename: 'shapes.csv' is a folder; expected a file");
}

TEST(BadObjects, NothingStartsOutsideOfTheArenaThoughALampReachesOut) {
    std::string const robots = "  crowd: {type: pogobot, nb: 20}\n";
    std::string const lamp = "  lamp: {type: static_light, geometry: disk, radius: 300, y: 500, x: ";
    EXPECT_EQ(error_with(robots + lamp + "500}\n", "lamp"), "no error");
    for (char const* x : {"0", "-500"}) {
        EXPECT_EQ(
            error_with(robots + lamp + x + "}\n", "lamp"),
            "x.yaml:4: initial_formation_root_object: 'lamp' reaches beyond the arena, which extends from (0.0, "
            "0.0) to (1000.0, 1000.0) mm, and some of its contents would start there; move it or make it smaller");
    }
}

TEST(MissingFiles, ConfigurationWithoutAnArenaIsToldTheKey) {
    Folder const folder;
    Warnings const warnings;
    Folder::write("test.csv", "0,0\n1,0\n1,1\n0,1\n");
    Folder::write("x.yaml", "objects:\n  robots: {type: pogobot}\n");
    EXPECT_EQ(error_of([] { build_world(load_scenario("x.yaml", {}, object_types()), 1); }),
              "x.yaml:1: the key 'arena_file' is missing; specify an outline, such as arenas/disk.csv");
}

TEST(MissingFiles, FilesOfOtherFormationsAreNotLookedFor) {
    Folder const folder;
    Warnings const warnings;
    Folder::write("square.csv", "0,0\n1,0\n1,1\n0,1\n");
    Folder::write("x.yaml",
                  "arena_file: square.csv\nformation_filename: none.csv\nobjects:\n  robots: {type: pogobot}\n");
    EXPECT_EQ(error_of([] { build_world(load_scenario("x.yaml", {}, object_types()), 1); }), "no error");
}

TEST(MissingFiles, FilesBesideTheConfigurationAreFoundAfterThoseOfTheWorkingFolder) {
    Folder const folder;
    Warnings const warnings;
    std::filesystem::create_directory("conf");
    Folder::write("conf/x.yaml", "arena_file: own.csv\narena_surface: file\nobjects:\n  robots: {type: pogobot}\n");
    auto const width_mm = [] {
        return build_world(load_scenario("conf/x.yaml", {}, object_types()), 1).arena.bounds.size().x;
    };
    Folder::write("conf/own.csv", "0,0\n500,0\n500,500\n0,500\n");
    EXPECT_EQ(width_mm(), 500.0F);
    Folder::write("own.csv", "0,0\n700,0\n700,500\n0,500\n");
    EXPECT_EQ(width_mm(), 700.0F);
}

TEST(MissingFiles, MessageSaysWhereWasLooked) {
    Folder const folder;
    Warnings const warnings;
    std::filesystem::create_directory("conf");
    std::string const here = std::filesystem::canonical(".").string();
    std::string const head = "objects:\n  robots: {type: pogobot}\narena_file: ";
    auto const message = [&](std::string const& file) {
        Folder::write("conf/x.yaml", head + file + "\n");
        return error_of([] { build_world(load_scenario("conf/x.yaml", {}, object_types()), 1); });
    };
    EXPECT_EQ(message("none.csv")
                  .find("conf/x.yaml:3: arena_file: there is no file 'none.csv'; searched " + here + ", then in " +
                        here + "/conf, then in "),
              0U)
        << message("none.csv");
    EXPECT_EQ(message("/none/at/all.csv"),
              "conf/x.yaml:3: arena_file: there is no file '/none/at/all.csv'. Bundled arenas: arenas/disk.csv, "
              "arenas/square.csv, ...");
}

TEST(ArenaScale, SizesOfTheFileAreKeptOnRequest) {
    Folder const folder;
    Warnings const warnings;
    Folder::write("hall.csv", "100,100\n2100,100\n2100,1300\n100,1300\n");
    Folder::write("x.yaml", "arena_file: hall.csv\narena_surface: file\nobjects:\n  robots: {type: pogobot}\n");
    Arena const arena = build_world(load_scenario("x.yaml", {}, object_types()), 1).arena;
    EXPECT_EQ(arena.bounds.min, (Vec2{0, 0}));
    EXPECT_EQ(arena.bounds.max, (Vec2{2000, 1200}));
    Folder::write("hall.csv", "0,0\n2e7,0\n2e7,1e3\n0,1e3\n");
    EXPECT_EQ(error_of([] { build_world(load_scenario("x.yaml", {}, object_types()), 1); }),
              "x.yaml:2: arena_surface: the arena 'hall.csv' measures 20000000.0 x 1000.0 mm; the largest supported "
              "size is 1000000 mm. Specify its area in mm2 instead of 'file'");
}

TEST(Boundary, ArenaFileThatSaysSoIsPeriodic) {
    Folder const folder;
    Warnings const warnings;
    Folder::write("torus.csv", "# boundary_condition: periodic\n0,0\n1,0\n1,1\n0,1\n");
    std::string const text = "arena_file: torus.csv\nobjects:\n  robots: {type: pogobot}\n";
    Folder::write("x.yaml", text);
    EXPECT_TRUE(build_world(load_scenario("x.yaml", {}, object_types()), 1).periodic);
    EXPECT_EQ(warnings.text(), "");
    Folder::write("x.yaml", text + "boundary_condition: solid\n");
    EXPECT_TRUE(build_world(load_scenario("x.yaml", {}, object_types()), 1).periodic);
    EXPECT_EQ(
        warnings.text(),
        "x.yaml:4: boundary_condition: ignored, because 'torus.csv' declares itself periodic; for walls, use another "
        "arena_file\n");
}

TEST(Boundary, WallsThatAPeriodicArenaDoesNotHaveMayHaveAnyPlace) {
    Folder const folder;
    Warnings const warnings;
    Folder::write("square.csv", "0,0\n1,0\n1,1\n0,1\n");
    std::string const text =
        "arena_file: square.csv\nobjects:\n  robots: {type: pogobot}\n"
        "  walls: {type: pogowall, geometry: disk, x: 5000, y: 0}\n";
    Folder::write("x.yaml", text + "boundary_condition: periodic\n");
    EXPECT_EQ(error_of([] { build_world(load_scenario("x.yaml", {}, object_types()), 1); }), "no error");
    Folder::write("x.yaml", text);
    EXPECT_NE(error_of([] { build_world(load_scenario("x.yaml", {}, object_types()), 1); }), "no error");
}

}  // namespace
}  // namespace pogosim
