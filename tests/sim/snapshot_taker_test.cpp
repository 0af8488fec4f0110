// What a picture gets to see of a run.
#include "sim/snapshot_taker.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "lamps/spot_lamp.hpp"
#include "support/objects.hpp"
#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using namespace testing;

SnapshotParts const kAll{.light = true, .links = true, .trails = true};

void idle() {}

void red_and_full_ahead() {
    pogobot_led_setColors(255, 0, 0, 0);
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
}

void start(Simulation& simulation) {
    ASSERT_FALSE(simulation.start());
}

TEST(Snapshot, HasThePosesAndLedsOfTheWorld) {
    use_program(idle, red_and_full_ahead);
    Simulation simulation(testing::test_program(), square_scene({robot_at({300, 300})}), {});
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 1.0));
    Snapshot const snapshot = simulation.snapshots().take({});
    World const& world = simulation.world();
    EXPECT_EQ(snapshot.step, 100);
    EXPECT_DOUBLE_EQ(snapshot.time_s, 1.0);
    EXPECT_EQ(snapshot.position_mm, world.bodies.position_mm);
    EXPECT_EQ(snapshot.heading_rad, world.bodies.heading_rad);
    ASSERT_EQ(snapshot.led.size(), 1U);
    EXPECT_EQ(snapshot.led[0][0], (Rgb{255, 0, 0}));
    EXPECT_GT(snapshot.position_mm[0].x, 350.0F);
    EXPECT_EQ(snapshot.light, nullptr);
    EXPECT_EQ(snapshot.trails, nullptr);
    EXPECT_TRUE(snapshot.links.empty());
}

TEST(Snapshot, StaysAsItIsWhileTheRunGoesOn) {
    use_program(idle, red_and_full_ahead);
    Simulation simulation(testing::test_program(), square_scene({robot_at({300, 300})}), {});
    start(simulation);
    Snapshot const before = simulation.snapshots().take(kAll);
    ASSERT_FALSE(run_for(simulation, 1.0));
    EXPECT_EQ(before.position_mm[0], (Vec2{300, 300}));
    EXPECT_EQ(before.scenery, simulation.snapshots().take({}).scenery);
}

TEST(Snapshot, ShowsBodiesOfAPeriodicArenaInsideIt) {
    use_program(idle, red_and_full_ahead);
    Scenario scenario = square_scene({robot_at({900, 500})});
    scenario.boundary = BoundaryCondition::periodic;
    Simulation simulation(testing::test_program(), scenario, {});
    start(simulation);
    for (int i = 0; i < 30; ++i) {
        ASSERT_FALSE(run_for(simulation, 0.2));
        Vec2 const place = simulation.snapshots().take({}).position_mm[0];
        EXPECT_TRUE(simulation.world().arena.bounds.contains(place)) << place.x;
    }
}

TEST(Snapshot, LightMapIsSharedUntilItChanges) {
    use_program(idle, idle);
    SpotSpec lamp;
    lamp.shape.kind = ShapeKind::global;
    lamp.value = 300;
    lamp.photo_start_at_s = 0.1F;
    lamp.photo_start_duration_s = 0.1F;
    lamp.photo_start_value = 1000;
    Simulation simulation(testing::test_program(), square_scene({robot_at({500, 500}), testing::lamp(lamp)}), {});
    start(simulation);
    SnapshotTaker& snapshots = simulation.snapshots();
    auto const dark = snapshots.take(kAll).light;
    ASSERT_FALSE(run_for(simulation, 0.05));
    EXPECT_EQ(snapshots.take(kAll).light, dark);
    ASSERT_FALSE(run_for(simulation, 0.1));
    auto const flash = snapshots.take(kAll).light;
    EXPECT_EQ(dark->at({500, 500}), 0);
    EXPECT_EQ(flash->at({500, 500}), 1000);
    EXPECT_EQ(flash->level, simulation.world().light.level);
}

TEST(Snapshot, LinksCountThePresentEmitterPower) {
    ObjectSpec spec = article_robot();
    spec.robot->ir.range_by_power_mm = {20.0F, 50.0F, 100.0F};
    use_program(idle, [] { pogobot_infrared_set_power(static_cast<uint8_t>(pogobot_ticks / 4)); });
    Simulation simulation(testing::test_program(),
                          square_scene({robot_at({400, 500}, spec), robot_at({500, 500}, spec)}), {});
    start(simulation);
    EXPECT_TRUE(simulation.snapshots().take(kAll).links.empty());  // power 1: 20 mm, and 47 mm lie between them
    bool linked = false;
    while (simulation.controllers().ticks(0) < 13) {
        ASSERT_FALSE(simulation.step());
        std::uint32_t const power = (simulation.controllers().ticks(0) - 1) / 4;
        linked = simulation.snapshots().take(kAll).links.size() == 1;
        EXPECT_EQ(linked, power >= 2) << simulation.controllers().ticks(0);
    }
    EXPECT_TRUE(linked);
}

TEST(Snapshot, LinksIncludeWallsAndMembranes) {
    use_program(idle, idle);
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "robots");
        pogobot_start(idle, idle, "walls");
        pogobot_start(idle, idle, "membranes");
    };
    Simulation simulation(
        testing::test_program(),
        square_scene({robot_at({60, 500}), robot_at({950, 500}), arena_wall(), at(membrane(), {700, 500})}), {});
    start(simulation);
    World const& world = simulation.world();
    auto const links = simulation.snapshots().take(kAll).links;
    ASSERT_EQ(links.size(), 3U);
    EXPECT_EQ(world.objects[links[0].to].category, 2);  // robot 0 and the wall
    EXPECT_EQ(links[0].from, 0U);
    EXPECT_NE(links[0].emitters_back, 0);
    EXPECT_EQ(links[1].from, 1U);
    EXPECT_EQ(links[2].from, 1U);  // robot 1 hears both
}

TEST(Snapshot, TrailsShowWhereRobotsHaveBeenSinceTheyAreFollowed) {
    use_program(idle, red_and_full_ahead);
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 500})}), {});
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 1.0));
    SnapshotTaker& snapshots = simulation.snapshots();
    for (int i = 0; i < 100; ++i) {
        ASSERT_FALSE(simulation.step());
        snapshots.follow_trails();
    }
    auto const trails = snapshots.take(kAll).trails;
    ASSERT_NE(trails, nullptr);
    EXPECT_NEAR(static_cast<float>(trails->size(0)), 100.0F / Trails::kSpacingMm, 20.0F);
    EXPECT_GT(trails->point(0, trails->size(0) - 1).position_mm.x, 270.0F);
    std::size_t const points = trails->size(0);
    ASSERT_FALSE(run_for(simulation, 0.1));
    snapshots.follow_trails();
    EXPECT_EQ(trails->size(0), points);  // the one that was handed out stays
}

TEST(Snapshot, TakingItChangesNothingInTheRun) {
    use_program([] { pogobot_infrared_set_power(3); },
                [] {
                    std::uint8_t byte = 1;
                    pogobot_infrared_sendShortMessage_omni(&byte, 1);
                    pogobot_motor_set(motorL, rand() % motorFull);
                    pogobot_motor_set(motorR, rand() % motorFull);
                });
    ObjectSpec spec = article_robot();
    spec.robot->linear_noise_stddev = 0.1F;
    spec.robot->ir.reception.rate = 0.5;
    Simulation plain(test_program(), square_scene({robots(20, spec)}), {});
    start(plain);
    ASSERT_FALSE(run_for(plain, 5.0));
    std::vector<Vec2> const expected = plain.world().bodies.position_mm;
    std::uint64_t const receptions = plain.channel().receptions();
    Simulation watched(test_program(), square_scene({robots(20, spec)}), {});
    start(watched);
    while (watched.world().step < plain.world().step) {
        ASSERT_FALSE(watched.step());
        watched.snapshots().follow_trails();
        watched.snapshots().take(kAll);
    }
    EXPECT_EQ(watched.world().bodies.position_mm, expected);
    EXPECT_EQ(watched.channel().receptions(), receptions);
}

TEST(Snapshot, LinksBetweenBodiesHaveTheLoadOfTheirTension) {
    use_program(idle, idle);
    Simulation simulation(testing::test_program(),
                          square_scene({robot_at({200, 500}), robot_at({300, 500}), robot_at({400, 500})}), {});
    World& world = simulation.world();
    world.link_categories = {{.name = "skin"}, {.name = "hidden", .are_drawn = false}};
    Link const spring{.a = 0, .b = 1, .end_a_mm = {20, 0}, .end_b_mm = {}, .tension_n = 0.5F};
    Link breaking = spring;
    breaking.breaking_n = 2.0F;
    Link const pushed{
        .kind = LinkKind::rod, .a = 2, .b = kNone, .end_a_mm = {}, .end_b_mm = {400, 600}, .tension_n = -1.0F};
    Link cut = spring;
    cut.is_cut = true;
    Link hidden = spring;
    hidden.link_category = 1;
    world.links = {spring, breaking, pushed, cut, hidden};
    std::vector<BodyLink> const links = simulation.snapshots().take({}).body_links;
    ASSERT_EQ(links.size(), 3U);
    EXPECT_EQ(links[0].from_mm, (Vec2{220, 500}));
    EXPECT_EQ(links[0].to_mm, (Vec2{300, 500}));
    EXPECT_EQ(links[0].load, 0.5F);  // of the largest tension
    EXPECT_FALSE(links[0].is_pinned);
    EXPECT_EQ(links[1].load, 0.25F);  // of its breaking force
    EXPECT_EQ(links[2].load, -1.0F);
    EXPECT_EQ(links[2].kind, LinkKind::rod);
    EXPECT_TRUE(links[2].is_pinned);
    EXPECT_EQ(links[2].to_mm, (Vec2{400, 600}));
}

TEST(Snapshot, LinkBetweenBodiesGoesOnBeyondTheSeam) {
    use_program(idle, idle);
    Simulation simulation(testing::test_program(), square_scene({robot_at({30, 500}), robot_at({960, 500})}), {});
    World& world = simulation.world();
    world.periodic = true;
    world.link_categories = {{.name = "skin"}};
    world.links = {{.a = 0, .b = 1, .end_a_mm = {}, .end_b_mm = {}}};
    std::vector<BodyLink> const links = simulation.snapshots().take({}).body_links;
    ASSERT_EQ(links.size(), 1U);
    EXPECT_EQ(links[0].from_mm.x, 30.0F);
    EXPECT_EQ(links[0].to_mm.x, 960.0F - world.arena.bounds.size().x);
}

}  // namespace
}  // namespace pogosim
