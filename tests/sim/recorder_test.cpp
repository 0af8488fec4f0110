// What a save of the data file has of the robots' programs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "device/link_edit.hpp"
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

// ---- Links ----

std::string metadata_of(ReadBack const& data, std::string const& key) {
    auto const found = data.table->schema()->metadata()->Get(key);
    return found.ok() ? *found : "";
}

NewLink weak_spring(std::uint32_t a, std::uint32_t b) {
    NewLink link{.kind = LinkKind::spring, .a = a, .b = b};
    link.length_mm = 60.0F;
    link.stiffness_n_m = 1e-6F;
    return link;
}

TEST(Recorder, RunWithLinksHasTheirTensionsAndTheseInItsMetadata) {
    TemporaryFolder const folder;
    use_exporting_program(nullptr);
    Simulation simulation(test_program(), recorded_scene(folder / "a.feather"), {});
    NewLink pinned = weak_spring(1, kNone);
    pinned.end_b_mm = {500, 20};
    pinned.breaking_n = 2.0F;
    add_link(simulation.world(), weak_spring(0, 4));
    add_link(simulation.world(), pinned);
    add_link(simulation.world(), weak_spring(0, 1));
    simulation.world().links[0].tension_n = 0.25F;
    simulation.world().links[2].tension_n = -0.5F;
    ASSERT_FALSE(simulation.start());
    simulation.finish();
    ReadBack const data = read_back(folder / "a.feather");
    EXPECT_EQ(data.text("tension", 0), "-0.5");  // the largest, as its amount counts
    EXPECT_EQ(data.text("tension", 1), "-0.5");
    EXPECT_EQ(data.text("tension", 2), "0");
    EXPECT_EQ(data.text("tension", 4), "0.25");
    EXPECT_EQ(metadata_of(data, "links"),
              R"({"objects":[["robots",0],["robots",1],["passive",65535]],"categories":[{"name":"made","drawn":true}],)"
              R"("category":[0,0,0],"kind":["spring","spring","spring"],"a":[0,1,0],"b":[2,-1,1],)"
              R"("end_a_mm":[[0,0],[0,0],[0,0]],"end_b_mm":[[0,0],[500,20],[0,0]],"rest_mm":[60,60,60],)"
              R"("stiffness_n_m":[1e-06,1e-06,1e-06],"damping_n_s_m":[0,0,0],"breaking_n":[null,2,null]})");
    EXPECT_EQ(metadata_of(data, "link_changes"), "");
}

TEST(Recorder, RunWithoutLinksHasNeitherColumnNorMetadataOfThem) {
    TemporaryFolder const folder;
    use_exporting_program(nullptr);
    ASSERT_EQ(Simulation(test_program(), recorded_scene(folder / "a.feather"), {}).run(), ExitCode::done);
    ReadBack const data = read_back(folder / "a.feather");
    EXPECT_EQ(data.table->GetColumnByName("tension"), nullptr);
    EXPECT_EQ(metadata_of(data, "links") + metadata_of(data, "link_changes"), "");
}

TEST(Recorder, MetadataSayWhenLinksWereMadeAndCut) {
    TemporaryFolder const folder;
    use_exporting_program(nullptr);
    Simulation simulation(test_program(), recorded_scene(folder / "a.feather"), {});
    add_link(simulation.world(), weak_spring(0, 1));
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(simulation.step());
    add_link(simulation.world(), weak_spring(2, 3));
    ASSERT_FALSE(simulation.step());
    ASSERT_FALSE(simulation.step());
    cut_link(simulation.world(), 0);
    ASSERT_FALSE(run_for(simulation, 0.1));
    simulation.finish();
    ReadBack const data = read_back(folder / "a.feather");
    EXPECT_EQ(metadata_of(data, "link_changes"),
              R"({"made":{"objects":[["robots",2],["robots",3]],"categories":[{"name":"made","drawn":true}],)"
              R"("category":[0],"kind":["spring"],"a":[0],"b":[1],"end_a_mm":[[0,0]],"end_b_mm":[[0,0]],)"
              R"("rest_mm":[60],"stiffness_n_m":[1e-06],"damping_n_s_m":[0],"breaking_n":[null],"time_s":[0.02]},)"
              R"("cut":{"link":[0],"time_s":[0.04]}})");
}

}  // namespace
}  // namespace pogosim
