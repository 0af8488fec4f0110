// Archives of flash memory, as far as the programs do not matter.
#include "sim/flash_state.hpp"

#include <gtest/gtest.h>

#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

TEST(FlashState, RobotWhoseIdHasMoreThan16BitsIsRefused) {
    testing::use_program([] {}, [] {});
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(1)}), {});
    TemporaryFolder const folder;
    Scenario scenario;
    scenario.flash_state.output_file = folder / "x.flash";
    World& world = simulation.world();
    world.robots.id[0] = kIdsOnAir - 1;
    EXPECT_NO_THROW(FlashState(scenario, world));
    world.robots.id[0] = kIdsOnAir;
    EXPECT_THROW(FlashState(scenario, world), ConfigError);
}

}  // namespace
}  // namespace pogosim
