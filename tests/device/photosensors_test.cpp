// Light sensors, without any program.
#include "device/sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/devices.hpp"

namespace pogosim {
namespace {

/// Light that grows to the right, by one count for each mm, from 0.
World lit(ObjectSpec const& spec) {
    World world = testing::world_with_robot(spec);
    world.light = {.columns = 1000, .rows = 1, .origin_mm = {0, 0}, .cell_mm = {1, 1000}, .level = {}};
    for (int column = 0; column < 1000; ++column) {
        world.light.level.push_back(static_cast<std::int16_t>(column));
    }
    return world;
}

TEST(Photosensors, ReadTheLightAtTheirPlacesOnTheRim) {
    World world = lit(testing::pogobot_spec());
    float const radius_mm = world.bodies.radius_mm[0];
    EXPECT_NEAR(read_photosensor(world, 0, 0), 500.0F - radius_mm, 1.0F);
    float const front_mm = 500.0F + radius_mm * std::cos(40.0F * 3.14159265F / 180.0F);
    EXPECT_NEAR(read_photosensor(world, 0, 1), front_mm, 1.0F);
    EXPECT_NEAR(read_photosensor(world, 0, 2), front_mm, 1.0F);
}

TEST(Photosensors, HaveTheirBiasAndTheBitsOfTheirConverter) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.robot->photosensor_bias = {.min = 320, .max = 320};
    spec.robot->sensors.photosensor_bits = 10;
    World world = lit(spec);
    int const light = static_cast<int>(500.0F - world.bodies.radius_mm[0]);
    EXPECT_EQ(read_photosensor(world, 0, 0), (light + 320) / 32);
}

TEST(Photosensors, NoiseIsDrawnFromTheRobotsStreamOnlyIfThereIsAny) {
    World world = lit(testing::pogobot_spec());
    RandomStream const before = world.robots.stream[0];
    read_photosensor(world, 0, 0);
    EXPECT_EQ(world.robots.stream[0], before);
    world.categories[0].spec.robot->photosensor_noise_stddev = 5.0F;
    read_photosensor(world, 0, 0);
    EXPECT_NE(world.robots.stream[0], before);
}

}  // namespace
}  // namespace pogosim
