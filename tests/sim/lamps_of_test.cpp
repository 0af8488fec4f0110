#include "sim/lamps_of.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "config/config_file.hpp"
#include "lamps/rotating_ray_lamp.hpp"
#include "lamps/spot_lamp.hpp"
#include "light/lighting.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

/// An arena of 1000 mm x 1000 mm with cells of 10 mm x 20 mm.
World world_of_cells() {
    World world = testing::square_world();
    world.light = make_light_map(world.arena, world.periodic, 100, 50);
    return world;
}

/// What is said of a lamp with these keys in that world; it is made all the same.
std::string warning_of_lamp(std::string const& type, std::string const& keys) {
    auto const load = [&] {
        config_file::Warnings const no_robots;
        return config_file::load("objects:\n  lamp:\n    type: " + type + "\n" + keys);
    };
    Scenario const scenario = load();
    config_file::Warnings const warnings;
    EXPECT_EQ(lamps_of(scenario, world_of_cells()).size(), static_cast<std::size_t>(scenario.objects[0].nb));
    return warnings.text();
}

std::string outside(int line, std::string const& key, std::string const& found) {
    return "x.yaml:" + std::to_string(line) + ": objects.lamp." + key + ": the lamp's centre " + found +
           " is outside the arena, which extends from (0.0, 0.0) to (1000.0, 1000.0) mm; coordinates of older "
           "configurations may need 'arena_stretch: true'\n";
}

TEST(LampsOf, SpotsOutsideOfTheArenaWarnWithTheirKey) {
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: disk\n    y: 500\n    x: 1500\n"),
              outside(6, "x", "(1500, 500)"));
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: rectangle\n    y: -2\n"), outside(5, "y", "(0, -2)"));
    EXPECT_EQ(
        warning_of_lamp("orbiting_static_light", "    geometry: disk\n    x: 10\n    y: 10\n    center_y: 1002.5\n"),
        outside(7, "center_y", "(10, 1002.5)"));
}

TEST(LampsOf, CategoryWithoutLampsDoesNotWarn) {
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: disk\n    x: 1500\n    nb: 0\n"), "");
}

TEST(LampsOf, SpotsOnTheWallsAndOrbitsThatLeadOutAreFine) {
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: triangle\n    side_length: 60\n    x: 1000\n    y: 0\n"),
              "");
    EXPECT_EQ(
        warning_of_lamp("orbiting_static_light", "    geometry: disk\n    orbit_radius: 2000\n    angular_speed: 1\n"),
        "");
}

TEST(LampsOf, LampsWithoutAPlaceOfTheirOwnAndLighthousesMayStandOutside) {
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: global\n    light_mode: gradient\n    x: -500\n"), "");
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: arena\n    light_mode: plane\n    x: -500\n"), "");
    EXPECT_EQ(warning_of_lamp("rotating_ray_of_light", "    geometry: disk\n    radius: 800\n    x: -500\n"), "");
}

TEST(LampsOf, SeveralOfOneEntryStandAtTheSamePlaceAndWarn) {
    std::string const nb = "    geometry: disk\n    radius: 50\n    x: 500\n    y: 500\n    nb: 5\n";
    std::string const same = "x.yaml:8: objects.lamp.nb: 5 lamps at the same place";
    EXPECT_EQ(warning_of_lamp("static_light", nb), same + "; their levels add up\n");
    EXPECT_EQ(warning_of_lamp("rotating_ray_of_light", nb), same + ", which look like one\n");
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: global\n    nb: 1\n"), "");
}

std::string dark(int line, std::string const& key, std::string const& when = "") {
    return "x.yaml:" + std::to_string(line) + ": objects.lamp." + key + ": the lamp lights no cell of the light map" +
           when +
           ": it covers no cell centre, and cells measure 10.0 mm x 20.0 mm; enlarge the lamp, or use more cells "
           "(light_map_nb_bin_x, light_map_nb_bin_y)\n";
}

TEST(LampsOf, LampsThatFallBetweenTheCentresOfCellsWarnWithTheKeyOfTheirSize) {
    std::string const corner = "    x: 500\n    y: 500\n";  // of four cells
    for (std::string const type :
         {"static_light", "orbiting_static_light", "rotating_ray_of_light", "alternating_rays_of_light"}) {
        EXPECT_EQ(warning_of_lamp(type, corner + "    geometry: disk\n    radius: 11\n"), dark(7, "radius"));
        EXPECT_EQ(warning_of_lamp(type, corner + "    geometry: disk\n"), dark(2, "radius")) << "the default";
        EXPECT_EQ(warning_of_lamp(type, corner + "    geometry: rectangle\n    body_width: 9\n    body_height: 50\n"),
                  dark(7, "body_width"));
        EXPECT_EQ(warning_of_lamp(type, corner + "    geometry: triangle\n    side_length: 8\n"),
                  dark(7, "side_length"));
        EXPECT_EQ(warning_of_lamp(type, corner + "    geometry: disk\n    radius: 12\n"), "");
    }
}

/// What is said of a lamp with these keys in a periodic arena.
std::string warning_of_periodic_lamp(std::string const& type, std::string const& keys) {
    config_file::Warnings const warnings;
    Scenario const scenario = config_file::load("objects:\n  lamp:\n    type: " + type + "\n" + keys);
    World world = testing::square_world();
    world.periodic = true;
    world.light = make_light_map(world.arena, world.periodic, 100, 50);
    std::string const before = warnings.text();
    lamps_of(scenario, world);
    return warnings.text().substr(before.size());
}

TEST(LampsOf, LightOfAPlaneInAPeriodicArenaJumpsOppositeToTheLamp) {
    std::string const plane = "    geometry: global\n    light_mode: plane\n    value: 100\n";
    EXPECT_EQ(warning_of_periodic_lamp("static_light", plane + "    x: 200\n    y: 0\n"),
              "x.yaml:7: objects.lamp.x: the light of a plane cannot go on across the borders of a periodic arena: it "
              "jumps at x = 700 mm, half the arena away from the lamp. With x: 500, it would jump at the border\n");
    EXPECT_EQ(warning_of_periodic_lamp("static_light", plane + "    x: 500\n    y: 0\n"), "");
    EXPECT_NE(warning_of_periodic_lamp("static_light", plane + "    x: 500\n    y: 0\n    plane_angle: 1.0\n")
                  .find("objects.lamp.y: the light of a plane"),
              std::string::npos);
    EXPECT_EQ(warning_of_periodic_lamp("static_light", plane + "    edge_value: 100\n    x: 200\n"), "");
    EXPECT_EQ(warning_of_periodic_lamp("static_light", "    geometry: global\n    light_mode: gradient\n    x: 200\n"),
              "");
    EXPECT_EQ(warning_of_periodic_lamp("static_light", "    geometry: disk\n    radius: 90\n    light_mode: plane\n"),
              "");
    EXPECT_EQ(warning_of_lamp("static_light", plane + "    x: 200\n    y: 0\n"), "");
}

TEST(LampsOf, SmallLampOnTheCentreOfACellIsSeen) {
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: disk\n    radius: 2\n    x: 505\n    y: 510\n"), "");
}

TEST(LampsOf, OrbitThatLeadsBetweenTheCentresOfCellsWarns) {
    std::string const orbit =
        "    geometry: disk\n    x: 505\n    y: 510\n    orbit_radius: 200\n    orbit_angular_speed: 1\n    radius: ";
    EXPECT_EQ(warning_of_lamp("orbiting_static_light", orbit + "8\n"), dark(9, "radius", " on parts of its orbit"));
    EXPECT_EQ(warning_of_lamp("orbiting_static_light", orbit + "12\n"), "");
}

TEST(LampsOf, LighthouseWhoseAreaIsOutsideOfTheArenaWarns) {
    EXPECT_EQ(warning_of_lamp("rotating_ray_of_light", "    geometry: disk\n    radius: 400\n    x: -500\n    y: 5\n"),
              dark(5, "radius"));
}

TEST(LampsOf, OrbitsStartAtTheirPhase) {
    SpotSpec spot;
    spot.centre_mm = {500, 300};
    spot.orbit = {.radius_mm = 100.0F, .angular_speed_rad_s = 1.0, .phase_rad = std::numbers::pi / 2.0};
    LampArea const area = area_at_start(spot);
    EXPECT_EQ(area.shape, spot.shape);
    EXPECT_NEAR(area.centre_mm.x, 500.0F, 1e-3F);
    EXPECT_NEAR(area.centre_mm.y, 400.0F, 1e-3F);
    EXPECT_EQ(area_at_start(RotatingRaySpec{{.shape = {}, .centre_mm = {7, 8}}}).centre_mm, (Vec2{7, 8}));
}

TEST(LampsOf, ThereAreAsManyAsTheFileSays) {
    config_file::Warnings const no_robots;
    Scenario const scenario = config_file::load(
        "objects:\n"
        "  a: {type: static_light, geometry: global, nb: 2, value: 7}\n"
        "  b: {type: rotating_ray_of_light, geometry: global}\n"
        "  c: {type: static_light, geometry: global, nb: 0}\n");
    std::vector<LampSpec> const lamps = lamps_of(scenario, world_of_cells());
    ASSERT_EQ(lamps.size(), 3U);
    EXPECT_EQ(lamps[1].get_if<SpotSpec>()->value, 7);
    EXPECT_TRUE(lamps[2].get_if<RotatingRaySpec>() != nullptr);
}

}  // namespace
}  // namespace pogosim
