#include "sim/lamps_of.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "config/config_file.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

/// What is said of a lamp with these keys in an arena of 1000 mm x 1000 mm; it is made all the same.
std::string warning_of_lamp(std::string const& type, std::string const& keys) {
    auto const load = [&] {
        config_file::Warnings const no_robots;
        return config_file::load("objects:\n  lamp:\n    type: " + type + "\n" + keys);
    };
    Scenario const scenario = load();
    config_file::Warnings const warnings;
    EXPECT_EQ(lamps_of(scenario, testing::square_world().arena).size(),
              static_cast<std::size_t>(scenario.objects[0].nb));
    return warnings.text();
}

std::string outside(int line, std::string const& key, std::string const& found) {
    return "x.yaml:" + std::to_string(line) + ": objects.lamp." + key + ": the lamp's centre " + found +
           " is outside of the arena, which spans (0.0, 0.0) to (1000.0, 1000.0) mm; coordinates of older "
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
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: triangle\n    x: 1000\n    y: 0\n"), "");
    EXPECT_EQ(warning_of_lamp("orbiting_static_light", "    geometry: disk\n    orbit_radius: 2000\n"), "");
}

TEST(LampsOf, LampsWithoutAPlaceOfTheirOwnAndLighthousesMayStandOutside) {
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: global\n    light_mode: gradient\n    x: -500\n"), "");
    EXPECT_EQ(warning_of_lamp("static_light", "    geometry: arena\n    light_mode: plane\n    x: -500\n"), "");
    EXPECT_EQ(warning_of_lamp("rotating_ray_of_light", "    geometry: disk\n    radius: 800\n    x: -500\n"), "");
}

TEST(LampsOf, OrbitsStartAtTheirPhase) {
    SpotSpec spot;
    spot.centre_mm = {500, 300};
    spot.orbit = {.radius_mm = 100.0F, .angular_speed_rad_s = 1.0, .phase_rad = std::numbers::pi / 2.0};
    LampArea const area = area_at_start(spot);
    EXPECT_EQ(area.shape, spot.shape);
    EXPECT_NEAR(area.centre_mm.x, 500.0F, 1e-3F);
    EXPECT_NEAR(area.centre_mm.y, 400.0F, 1e-3F);
    EXPECT_EQ(area_at_start(RotatingRaySpec{.shape = {}, .centre_mm = {7, 8}}).centre_mm, (Vec2{7, 8}));
}

TEST(LampsOf, ThereAreAsManyAsTheFileSays) {
    config_file::Warnings const no_robots;
    Scenario const scenario = config_file::load(
        "objects:\n"
        "  a: {type: static_light, geometry: global, nb: 2, value: 7}\n"
        "  b: {type: rotating_ray_of_light, geometry: global}\n"
        "  c: {type: static_light, geometry: global, nb: 0}\n");
    std::vector<LampSpec> const lamps = lamps_of(scenario, testing::square_world().arena);
    ASSERT_EQ(lamps.size(), 3U);
    EXPECT_EQ(std::get<SpotSpec>(lamps[1]).value, 7);
    EXPECT_TRUE(std::holds_alternative<RotatingRaySpec>(lamps[2]));
}

}  // namespace
}  // namespace pogosim
