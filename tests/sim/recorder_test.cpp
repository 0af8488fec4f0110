// What a save of the data file has of the robots' programs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "record/scratch.hpp"
#include "support/objects.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using namespace testing;

std::vector<int> exported;  // ids of robots, in the order of their callbacks

void export_own_id() {
    exported.push_back(pogobot_helper_getid());
    data_set_value_int32("own", pogobot_helper_getid());
    data_set_value_string("name", "a text that is longer than a small string");
}

void use_exporting_program(void (*export_data)()) {
    static void (*callback)() = nullptr;
    callback = export_data;
    exported.clear();
    program_main = [] {
        pogobot_init();
        pogobot_start([] {}, [] { pogobot_led_setColor(static_cast<uint8_t>(pogobot_ticks), 0, 0); });
        callback_create_data_schema = [] {
            data_add_column_int32("own");
            data_add_column_string("name");
        };
        callback_export_data = callback;
    };
}

Scenario recorded_scene(std::string const& path) {
    Scenario scenario = square_scene({robots(4), at(passive_object({.radius_mm = 30.0F}), {500, 500})});
    scenario.simulation_time_s = 0.2;
    scenario.output.enable_data_logging = true;
    scenario.output.data_filename = path;
    scenario.output.save_data_period_s = 0.1;
    scenario.output.led_column = true;
    return scenario;
}

TEST(Recorder, EveryRowHasTheValuesOfItsOwnRobot) {
    TemporaryFolder const folder;
    use_exporting_program(export_own_id);
    ASSERT_EQ(Simulation(test_program(), recorded_scene(folder / "a.feather"), {}).run(), ExitCode::done);
    EXPECT_EQ(exported, (std::vector<int>{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}));
    ReadBack const data = read_back(folder / "a.feather");
    ASSERT_EQ(data.table->num_rows(), 15);
    for (int row = 0; row < 15; ++row) {
        bool const is_robot = row % 5 < 4;
        EXPECT_EQ(data.text("own", row), is_robot ? data.text("robot_id", row) : "null");
        EXPECT_EQ(data.text("name", row), is_robot ? "a text that is longer than a small string" : "null");
    }
    EXPECT_EQ(data.text("robot_id", 14), "65535");
}

TEST(Recorder, RobotThatDisablesItsRowLeavesThoseOfTheOthers) {
    TemporaryFolder const folder;
    use_exporting_program([] {
        export_own_id();
        if (pogobot_helper_getid() % 2 == 1) {
            disable_data_export();
        }
    });
    ASSERT_EQ(Simulation(test_program(), recorded_scene(folder / "a.feather"), {}).run(), ExitCode::done);
    ReadBack const data = read_back(folder / "a.feather");
    ASSERT_EQ(data.table->num_rows(), 9);
    EXPECT_EQ(data.text("own", 0), "0");
    EXPECT_EQ(data.text("own", 1), "2");
    EXPECT_EQ(data.text("own", 2), "null");
}

TEST(Recorder, CrashWhileExportingLeavesTheRowsOfTheRobotsBefore) {
    TemporaryFolder const folder;
    use_exporting_program([] {
        export_own_id();
        if (pogobot_ticks > 0 && pogobot_helper_getid() == 2) {
            std::abort();
        }
    });
    EXPECT_EQ(Simulation(test_program(), recorded_scene(folder / "a.feather"), {}).run(), ExitCode::user_program);
    ReadBack const data = read_back(folder / "a.feather");
    ASSERT_EQ(data.table->num_rows(), 7);
    EXPECT_EQ(data.text("own", 5), "0");
    EXPECT_EQ(data.text("own", 6), "1");
}

TEST(Recorder, ColourThatARobotSetsWhileExportingIsInItsRow) {
    TemporaryFolder const folder;
    use_exporting_program([] { pogobot_led_setColor(0, 0, static_cast<uint8_t>(1 + pogobot_helper_getid())); });
    Simulation simulation(test_program(), recorded_scene(folder / "a.feather"), {});
    ASSERT_FALSE(simulation.start());
    // A colour of another than the program is recorded, too, until the program sets one.
    simulation.world().robots.led[0][0] = {.r = 1};
    use_exporting_program(nullptr);
    simulation.finish();
    ReadBack const data = read_back(folder / "a.feather");
    for (int row = 0; row < 4; ++row) {
        EXPECT_EQ(data.text("led_rgb", row), std::to_string(row + 1));
    }
}

TEST(WrittenWorld, LightsAndColoursOfOthersAreSensedShownAndRecorded) {
    TemporaryFolder const folder;
    static int sensed = -1;
    program_main = [] {
        pogobot_init();
        pogobot_start([] {}, [] { sensed = pogobot_photosensors_read(0); });
    };
    Scenario scenario = recorded_scene(folder / "a.feather");
    Simulation simulation(test_program(), scenario, {});
    ASSERT_FALSE(simulation.start());
    World& world = simulation.world();
    EXPECT_EQ(simulation.snapshots().take({.light = true}).light->level[0], 0);
    std::ranges::fill(world.light.level, std::int16_t{1234});
    world.robots.led[1][0] = {.r = 0, .g = 2, .b = 3};
    ASSERT_FALSE(run_for(simulation, 0.1));
    EXPECT_EQ(sensed, 1234);
    Snapshot const snapshot = simulation.snapshots().take({.light = true});
    EXPECT_EQ(snapshot.light->level[0], 1234);
    EXPECT_EQ(snapshot.led[1][0], (Rgb{.r = 0, .g = 2, .b = 3}));
    simulation.finish();
    EXPECT_EQ(read_back(folder / "a.feather").text("led_rgb", 6), std::to_string(0x000203));
}

}  // namespace
}  // namespace pogosim
