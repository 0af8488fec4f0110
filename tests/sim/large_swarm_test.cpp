// More robots than ids of 16 bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "config/config_file.hpp"
#include "record/scratch.hpp"
#include "sim/build_world.hpp"
#include "support/objects.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using namespace testing;
using config_file::Warnings;

constexpr int kIds = 65536;
constexpr double kAreaPerRobotMm2 = 1e4;

/// A crowd on a grid, then robots that stand alone in the corners, and a wall.
Scenario swarm_scene(int crowd, std::vector<ObjectConfig> others) {
    std::vector<ObjectConfig> objects{robots(crowd, article_robot(), "crowd")};
    objects.insert(objects.end(), others.begin(), others.end());
    objects.push_back(arena_wall());
    Scenario scenario = square_scene(objects, std::sqrt(2.0 * crowd * kAreaPerRobotMm2));
    scenario.formation.name = "chessboard";
    scenario.formation.cluster_at_centre = true;
    return scenario;
}

std::set<std::uint32_t> different_ids(World const& world) {
    std::set<std::uint32_t> ids;
    for (Object const& object : world.objects) {
        ids.insert(object.id);
    }
    return ids;
}

TEST(LargeSwarm, ObjectsHaveIdsOfTheirOwnWhateverTheirNumber) {
    for (int const crowd : {kIds - 2, kIds - 1, kIds}) {
        Warnings const warnings;
        World const world = build_world(swarm_scene(crowd, {}), 1);
        auto const count = static_cast<std::uint32_t>(crowd) + 1;
        EXPECT_EQ(different_ids(world).size(), count);
        EXPECT_EQ(world.objects.front().id, 0U);
        EXPECT_EQ(world.objects.back().id, std::max(count, 65536U) - 1);  // the wall
        EXPECT_EQ(world.robots.id[world.objects.back().robot], world.objects.back().id);
        EXPECT_EQ(warnings.text().find("65537 objects run the program, but") != std::string::npos, crowd == kIds);
        EXPECT_EQ(warnings.text().find("objects run the program") != std::string::npos, crowd == kIds);
    }
}

// What robots of the test below hear.
std::vector<int> heard;

void greet() {
    if (pogobot_ticks == 1) {
        std::uint8_t greeting = 42;
        pogobot_infrared_sendLongMessage_omniSpe(&greeting, 1);
    }
}

void count_ticks() {
    ++mydata->number[0];
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
}

TEST(LargeSwarm, SeventyThousandRobotsDriveTalkAndAreRecorded) {
    constexpr int kCrowd = 70000;
    constexpr std::uint32_t kSender = kCrowd;  // the first robot after the crowd
    TemporaryFolder const folder;
    heard.clear();
    program_main = [] {
        pogobot_init();
        pogobot_start([] {}, count_ticks, "crowd");
        pogobot_start([] {}, greet, "sender");
        pogobot_start([] {}, [] {}, "walls");
        pogobot_start(
            [] {
                msg_rx_fn = [](message_t* message) { heard.push_back(message->header._sender_id); };
                percent_msgs_sent_per_ticks = 0;
            },
            [] {}, "listener");
    };
    Scenario scenario = swarm_scene(
        kCrowd, {robot_at({100, 100}, article_robot(), "sender"), robot_at({100, 180}, article_robot(), "listener")});
    scenario.output.enable_data_logging = true;
    scenario.output.data_filename = folder / "large.feather";
    scenario.output.save_data_period_s = 0.1;
    Simulation simulation(test_program(), scenario, {});
    World const& world = simulation.world();
    ASSERT_EQ(world.robots.size(), kCrowd + 3U);
    std::vector<Vec2> const before = world.bodies.position_mm;
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(run_for(simulation, 0.1));

    // All robots of the crowd have moved, and no others.
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        EXPECT_EQ(world.bodies.position_mm[i] != before[i], i < kCrowd) << i;
    }
    // One message for each face of the listener that sees one of the sender's emitters.
    ASSERT_FALSE(heard.empty());
    for (int const id : heard) {
        EXPECT_EQ(id, static_cast<int>(kSender) - kIds);
    }
    simulation.finish();
    ReadBack const data = read_back(folder / "large.feather");
    std::int64_t const rows = kCrowd + 3;
    ASSERT_EQ(data.table->num_rows(), 2 * rows);
    EXPECT_EQ(data.text("robot_id", 65535), "65535");
    EXPECT_EQ(data.text("robot_id", 65536), "65536");
    EXPECT_EQ(data.text("robot_id", kSender), std::to_string(kSender));
    EXPECT_EQ(data.text("robot_category", kSender), "sender");
    EXPECT_EQ(data.text("robot_id", rows - 1), std::to_string(kCrowd + 2));
    EXPECT_EQ(data.text("robot_category", rows - 1), "walls");
}

}  // namespace
}  // namespace pogosim
