// Long runs of a crowd in every arena of the project.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/grid.hpp"
#include "geometry/arena.hpp"
#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

#ifdef POGOSIM_SANITIZED
constexpr double kSeconds = 4.0;  // the sanitizers make it thirty times slower
#else
constexpr double kSeconds = 120.0;
#endif
constexpr int kRobots = 300;
constexpr float kRadiusMm = 26.5F;
constexpr float kToleranceMm = 1.0F;

/// Those with walls.
std::vector<std::string> arena_files() {
    std::vector<std::string> files;
    for (auto const& entry : std::filesystem::directory_iterator(POGOSIM_SOURCE_DIR "/arenas")) {
        if (entry.path().extension() == ".csv" && !read_arena_file(entry.path()).periodic) {
            files.push_back(entry.path().stem().string());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// A random walk that likes to push: full speed ahead most of the time, into walls and neighbours.
void pushing_walk() {
    if (pogobot_ticks % 60 == static_cast<uint32_t>(pogobot_helper_getid() % 60)) {
        bool const turn = rand() % 3 == 0;
        pogobot_motor_set(motorL, motorFull);
        pogobot_motor_set(motorR, turn ? motorStop : motorFull);
    }
}

float deepest_overlap_mm(World const& world) {
    UniformGrid grid;
    grid.build(world.bodies.position_mm, world.arena.bounds, 2.0F * kRadiusMm, world.periodic);
    float deepest = 0.0F;
    for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
        grid.for_each_near(world.bodies.position_mm[i], 2.0F * kRadiusMm, [&](std::uint32_t j, Vec2 /*point*/) {
            if (j != i) {
                float const distance = length(world.bodies.position_mm[j] - world.bodies.position_mm[i]);
                deepest = std::max(deepest, 2.0F * kRadiusMm - distance);
            }
        });
    }
    return deepest;
}

class EveryArena : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryArena, KeepsItsRobotsInsideAndApart) {
    testing::use_program(nullptr, pushing_walk);
    Scenario scenario = testing::square_scene({testing::robots(kRobots)});
    scenario.arena_file = POGOSIM_SOURCE_DIR "/arenas/" + GetParam() + ".csv";
    scenario.arena_surface_mm2 = 3.0e6;
    scenario.formation.name = "power_lloyd";
    Simulation simulation(testing::test_program(), std::move(scenario), {});
    ASSERT_FALSE(simulation.start());
    float deepest_in_wall_mm = 0.0F;
    float deepest_overlap = 0.0F;
    for (double t = 0.0; t < kSeconds; t += 0.5) {
        ASSERT_FALSE(testing::run_for(simulation, 0.5));
        World const& world = simulation.world();
        for (Vec2 const position : world.bodies.position_mm) {
            ASSERT_TRUE(world.arena.contains(position)) << position.x << ", " << position.y << " at " << t << " s";
            deepest_in_wall_mm = std::max(deepest_in_wall_mm, kRadiusMm - world.arena.distance_to_walls(position));
        }
        deepest_overlap = std::max(deepest_overlap, deepest_overlap_mm(world));
    }
    EXPECT_LT(deepest_in_wall_mm, kToleranceMm);
    EXPECT_LT(deepest_overlap, kToleranceMm);
    RecordProperty("deepest_overlap_um", static_cast<int>(1000.0F * deepest_overlap));
}

INSTANTIATE_TEST_SUITE_P(Arenas, EveryArena, ::testing::ValuesIn(arena_files()),
                         [](auto const& info) { return info.param; });

}  // namespace
}  // namespace pogosim
