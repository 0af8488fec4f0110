// What callbacks of the whole run see and change: pogosim/world.h.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "lamps/spot_lamp.hpp"
#include "record/scratch.hpp"
#include "support/objects.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using namespace testing;

void idle() {}

void full_ahead() {
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
    pogobot_led_setColors(1, 2, 3, 0);
}

TestData& mine() {
    return *static_cast<TestData*>(mydata);
}

/// What each test's callback of the whole run does, in the steps from the first one on.
void (*supervise)() = idle;

void use_supervised(void (*init)(), void (*step)(), void (*supervisor)()) {
    supervise = supervisor;
    program_main = [=] {
        pogobot_init();
        pogobot_start(init, step, "robots");
        callback_global_step = [] { supervise(); };
    };
}

TestData const& data_of(Simulation const& simulation, std::size_t robot) {
    return *reinterpret_cast<TestData const*>(simulation.controllers().controller_of(robot).user_data);
}

ObjectConfig bright_disk(Vec2 centre_mm, int value) {
    SpotSpec spot;
    spot.shape.radius_mm = 100.0F;
    spot.centre_mm = centre_mm;
    spot.value = value;
    return lamp(spot);
}

/// Kills robot 0 from 0.5 s to 1 s.
void kill_for_half_a_second() {
    double const time_s = pogosim_world_time();
    pogosim_world_set_alive(0, time_s < 0.495 || time_s >= 0.995);
}

TEST(Supervisor, SeesTruePosesInTheOrderOfTheConfiguration) {
    static pogosim_pose_t puck;
    static uint32_t index;
    static uint32_t count;
    use_supervised(idle, idle, [] {
        count = pogosim_world_object_count();
        index = pogosim_world_object("passive", 0);
        pogosim_world_pose(index, &puck);
    });
    Simulation simulation(testing::test_program(),
                          square_scene({robot_at({200, 200}), at(passive_object({.radius_mm = 40.0F}), {300, 700})}),
                          {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(simulation.step());
    EXPECT_EQ(count, 2U);
    EXPECT_EQ(index, 1U);
    EXPECT_EQ(puck.x_mm, 300.0);
    EXPECT_EQ(puck.y_mm, 700.0);
}

TEST(Supervisor, MovedObjectIsThereInTheSameStepAndAWallIsNoPlace) {
    static bool moved;
    static bool into_wall;
    use_supervised(idle, idle, [] {
        if (pogosim_world_time() == 0.0) {
            moved = pogosim_world_set_pose(1, 600, 650, 1.0);
            into_wall = pogosim_world_set_pose(0, 1, 500, 0.0);
        }
    });
    Simulation simulation(testing::test_program(),
                          square_scene({robot_at({200, 200}), at(passive_object({.radius_mm = 40.0F}), {300, 700})}),
                          {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(simulation.step());
    EXPECT_TRUE(moved);
    EXPECT_FALSE(into_wall);
    Bodies const& bodies = simulation.world().bodies;
    EXPECT_EQ(bodies.position_mm[1], (Vec2{600, 650}));
    EXPECT_NEAR(bodies.heading_rad[1], 1.0F, 1e-6F);
    EXPECT_EQ(bodies.position_mm[0], (Vec2{200, 200}));
    EXPECT_FALSE(simulation.is_touched());
}

TEST(Supervisor, RobotsSenseTheLampThatWasSwitchedInTheSameStep) {
    use_supervised(
        idle, [] { mine().number[pogobot_ticks % 8] = pogobot_photosensors_read(0); },
        [] {
            if (pogosim_world_time() > 0.095) {
                pogosim_world_set_lamp_on(0, false);  // asking for the light would be a reason of its own to update it
            } else {
                EXPECT_EQ(pogosim_world_light(0), 1000.0);
            }
        });
    Simulation simulation(testing::test_program(), square_scene({robot_at({500, 500}), bright_disk({500, 500}, 1000)}),
                          {});
    ASSERT_FALSE(simulation.start());
    int ticks = 0;
    while (simulation.world().time_s() < 0.2) {
        double const time_s = simulation.world().time_s();
        ASSERT_FALSE(simulation.step());
        int const now = static_cast<int>(simulation.controllers().ticks(0));
        if (now != std::exchange(ticks, now)) {
            EXPECT_EQ(data_of(simulation, 0).number[static_cast<std::size_t>(now - 1) % 8], time_s > 0.095 ? 0 : 1000)
                << time_s;
        }
    }
    EXPECT_GT(ticks, 8);
}

TEST(Supervisor, LampIsDimmedAndMovedAndNoLevelLeavesTheSensorsRange) {
    static std::vector<double> levels;
    levels.clear();
    use_supervised(idle, idle, [] {
        if (pogosim_world_time() > 0.0) {
            return;
        }
        auto const look = [] {
            levels.push_back(pogosim_world_light_at(500, 500));
            levels.push_back(pogosim_world_light_at(200, 200));
        };
        look();
        pogosim_world_set_lamp_intensity(0, 0.25);
        look();
        pogosim_world_set_lamp_position(0, 200, 200);
        look();
        pogosim_world_set_lamp_intensity(0, 1e6);
        look();
        pogosim_world_set_lamp_intensity(0, 1.0);
        pogosim_world_set_lamp_position(0, 500, 500);
        look();
    });
    Simulation simulation(testing::test_program(), square_scene({robot_at({800, 800}), bright_disk({500, 500}, 1000)}),
                          {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(simulation.step());
    EXPECT_EQ(levels, (std::vector<double>{1000, 0, 250, 0, 0, 250, 0, 32767, 1000, 0}));
}

TEST(Supervisor, RobotThatIsSwitchedOffStandsStillAndDarkAndGoesOnWhereItWas) {
    use_supervised(
        idle,
        [] {
            ++mine().number[0];
            full_ahead();
        },
        kill_for_half_a_second);
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 200})}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(run_for(simulation, 0.5));
    std::uint32_t const ticks = simulation.controllers().ticks(0);
    float const x = simulation.world().bodies.position_mm[0].x;
    EXPECT_NEAR(x, 250, 2);
    ASSERT_FALSE(run_for(simulation, 0.5));
    EXPECT_EQ(simulation.world().bodies.position_mm[0].x, x);
    EXPECT_EQ(simulation.world().robots.led[0][0], Rgb{});
    EXPECT_EQ(simulation.controllers().ticks(0), ticks);
    ASSERT_FALSE(simulation.step());
    EXPECT_EQ(simulation.world().robots.led[0][0], (Rgb{1, 2, 3}));
    ASSERT_FALSE(run_for(simulation, 0.49));
    EXPECT_NEAR(simulation.world().bodies.position_mm[0].x, x + 50, 2);
    EXPECT_EQ(data_of(simulation, 0).number[0], simulation.controllers().ticks(0));
    EXPECT_GT(simulation.controllers().ticks(0), ticks + 20);
}

TEST(Supervisor, ClockOfARobotThatWasSwitchedOffHasGoneOn) {
    use_supervised(
        idle,
        [] {
            mine().number[0] = std::max(mine().number[0], current_time_milliseconds() - mine().number[1]);
            mine().number[1] = current_time_milliseconds();
        },
        kill_for_half_a_second);
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 200})}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(run_for(simulation, 1.5));
    EXPECT_NEAR(static_cast<double>(data_of(simulation, 0).number[0]), 510.0, 20.0);
    EXPECT_NEAR(static_cast<double>(data_of(simulation, 0).number[1]), 1490.0, 20.0);
}

TEST(Supervisor, RobotThatIsSwitchedOffNeitherSendsNorReceives) {
    auto const send_and_count = [] {
        uint8_t byte = 1;
        pogobot_infrared_sendShortMessage_omni(&byte, 1);
        message_t message;
        while (pogobot_infrared_message_available()) {
            pogobot_infrared_recover_next_message(&message);
            ++mine().number[0];
        }
    };
    use_supervised(idle, send_and_count, kill_for_half_a_second);
    Simulation simulation(testing::test_program(), square_scene({robot_at({400, 500}), robot_at({500, 500})}), {});
    ASSERT_FALSE(simulation.start());
    auto const received = [&](std::size_t robot) { return data_of(simulation, robot).number[0]; };
    ASSERT_FALSE(run_for(simulation, 0.55));
    auto const first = received(0);
    auto const second = received(1);
    int const waiting = simulation.world().mailboxes.size(0);
    EXPECT_GT(first, 20);
    EXPECT_GT(second, 20);
    ASSERT_FALSE(run_for(simulation, 0.44));
    EXPECT_EQ(received(0), first);
    EXPECT_EQ(received(1), second);
    EXPECT_EQ(simulation.world().mailboxes.size(0), waiting);  // from before it was switched off
    ASSERT_FALSE(run_for(simulation, 0.5));
    EXPECT_GT(received(0), first + 20);
    EXPECT_GT(received(1), second + 20);
}

TEST(Supervisor, BodyOfARobotThatIsSwitchedOffCanBePushed) {
    use_supervised(idle, full_ahead, [] { pogosim_world_set_alive(1, false); });
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 200}), robot_at({300, 200})}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(run_for(simulation, 4.0));
    EXPECT_GT(simulation.world().bodies.position_mm[1].x, 310.0F);
    EXPECT_GT(length(simulation.world().bodies.position_mm[1] - simulation.world().bodies.position_mm[0]), 52.0F);
}

TEST(Supervisor, RobotSwitchedOffBeforeItsInitRunsFromWhenItIsSwitchedOn) {
    program_main = [] {
        pogobot_init();
        pogobot_start([] { pogobot_led_setColors(9, 9, 9, 0); }, [] { ++mine().number[0]; }, "robots");
        callback_global_setup = [] { pogosim_world_set_alive(0, false); };
        callback_global_step = [] { pogosim_world_set_alive(0, pogosim_world_time() > 0.495); };
    };
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 200})}), {});
    ASSERT_FALSE(simulation.start());
    EXPECT_EQ(simulation.world().robots.led[0][0], Rgb{});
    ASSERT_FALSE(run_for(simulation, 0.5));
    EXPECT_EQ(data_of(simulation, 0).number[0], 0);
    ASSERT_FALSE(run_for(simulation, 0.5));
    EXPECT_EQ(simulation.world().robots.led[0][0], (Rgb{9, 9, 9}));
    EXPECT_NEAR(static_cast<double>(data_of(simulation, 0).number[0]), 30, 3);
}

TEST(Supervisor, ClickCanSwitchTheClickedRobotOffAndOn) {
    program_main = [] {
        pogobot_init();
        pogobot_start(
            idle, [] { ++mine().number[0]; }, "robots");
        callback_robot_click = [] {
            pogosim_world_set_alive(pogobot_helper_getid(), !pogosim_world_is_alive(pogobot_helper_getid()));
            pogobot_led_setColors(5, 5, 5, 0);
            msleep(3);
        };
    };
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 200}), robot_at({500, 500})}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(run_for(simulation, 0.5));
    auto const ticks = data_of(simulation, 1).number[0];
    EXPECT_FALSE(simulation.click(1));
    EXPECT_EQ(simulation.world().robots.led[1][0], Rgb{});
    ASSERT_FALSE(run_for(simulation, 0.5));
    EXPECT_EQ(data_of(simulation, 1).number[0], ticks);
    EXPECT_GT(data_of(simulation, 0).number[0], ticks + 20);
    EXPECT_FALSE(simulation.click(1));
    EXPECT_EQ(simulation.world().robots.led[1][0], (Rgb{5, 5, 5}));
    ASSERT_FALSE(run_for(simulation, 0.5));
    EXPECT_NEAR(static_cast<double>(data_of(simulation, 1).number[0] - ticks), 31, 3);
}

TEST(Supervisor, UserDataOfRobotsAreTheirMemory) {
    use_supervised(
        idle, [] { mine().number[1] = mine().number[0] + 1; },
        [] {
            EXPECT_EQ(pogosim_world_user_data(2), nullptr);
            for (uint32_t i = 0; i < 2; ++i) {
                static_cast<TestData*>(pogosim_world_user_data(i))->number[0] = 10 * i;
            }
        });
    Simulation simulation(testing::test_program(),
                          square_scene({robot_at({200, 200}), robot_at({500, 500}),
                                        at(passive_object({.radius_mm = 40.0F}), {300, 700})}),
                          {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(simulation.step());
    EXPECT_EQ(data_of(simulation, 0).number[1], 1);
    EXPECT_EQ(data_of(simulation, 1).number[1], 11);
}

TEST(Supervisor, ColumnsStandInAllRowsUnlessARobotSetsItsOwn) {
    TemporaryFolder const folder;
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "robots");
        callback_create_data_schema = [] {
            data_add_column_double("fitness");
            data_add_column_int8("group");
            pogosim_world_set_column("fitness", 0.5);
        };
        callback_global_step = [] {
            pogosim_world_set_column("fitness", pogosim_world_time() * 10.0);
            pogosim_world_set_object_column(2, "group", 7);
        };
        callback_export_data = [] {
            if (pogobot_helper_getid() == 1) {
                data_set_value_double("fitness", -1.0);
            }
        };
    };
    Scenario scenario = square_scene(
        {robot_at({200, 200}), robot_at({500, 500}), at(passive_object({.radius_mm = 40.0F}), {300, 700})});
    scenario.output.enable_data_logging = true;
    scenario.output.data_filename = folder / "a.feather";
    scenario.output.save_data_period_s = 1.0;
    Simulation simulation(testing::test_program(), scenario, {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(run_for(simulation, 1.0));
    simulation.finish();
    ReadBack const data = read_back(folder / "a.feather");
    std::vector<std::string> fitness;
    std::vector<std::string> group;
    for (int row = 0; row < 6; ++row) {
        fitness.push_back(data.text("fitness", row));
        group.push_back(data.text("group", row));
    }
    EXPECT_EQ(fitness[0], "0.5");
    EXPECT_EQ(fitness[1], "-1");
    EXPECT_EQ(fitness[2], "0.5");
    EXPECT_NEAR(std::stod(fitness[3]), 9.9, 0.11);
    EXPECT_EQ(fitness[4], "-1");
    EXPECT_EQ(fitness[5], fitness[3]);
    EXPECT_EQ(group, (std::vector<std::string>{"null", "null", "null", "null", "null", "7"}));
}

TEST(Supervisor, StateHashTellsOfSwitchedOffRobotsAndOfLamps) {
    use_supervised(idle, idle, idle);
    auto const hash_after = [](auto const& change) {
        Simulation simulation(testing::test_program(),
                              square_scene({robot_at({200, 200}), bright_disk({500, 500}, 1000)}), {});
        EXPECT_FALSE(simulation.start());
        change(simulation);
        return simulation.hash();
    };
    std::uint64_t const plain = hash_after([](Simulation&) {});
    EXPECT_EQ(hash_after([](Simulation& s) {
                  s.set_alive(0, false);
                  s.set_alive(0, true);
                  s.set_lamp(0, {.is_on = false, .moved_mm = {}});
                  s.set_lamp(0, {});
              }),
              plain);
    EXPECT_NE(hash_after([](Simulation& s) { s.set_alive(0, false); }), plain);
    EXPECT_NE(hash_after([](Simulation& s) { s.set_lamp(0, {.is_on = false, .moved_mm = {}}); }), plain);
    EXPECT_NE(hash_after([](Simulation& s) { s.set_lamp(0, {.moved_mm = {1e-3F, 0}}); }), plain);
}

TEST(Supervisor, RefusedCallsEndTheRunWithOneMessage) {
    static void (*wrong)();
    using Case = std::pair<void (*)(), std::string>;
    static pogosim_pose_t pose;
    for (auto const& [call, message] : std::vector<Case>{
             {[] { pogosim_world_pose(2, &pose); },
              "pogosim_world_pose(): there is no object 2: the run has 2, from 0 to 1"},
             {[] { pogosim_world_set_lamp_on(0, true); },
              "pogosim_world_set_lamp_on(): there is no lamp 0: the run has none"},
             {[] { pogosim_world_set_alive(1, false); },
              "pogosim_world_set_alive(): object 1 of category 'passive' runs no program"},
             {[] { pogosim_world_set_pose(0, NAN, 0, 0); },
              "pogosim_world_set_pose(): x_mm: expected a finite number, found nan"},
             {[] { pogosim_world_light_at(0, 1e300); },
              "pogosim_world_light_at(): y_mm: expected a finite number, found 1e+300"},
             {[] { pogosim_world_cut_link(0); }, "pogosim_world_cut_link(): there is no link 0: the run has none"},
             {[] { pogosim_world_new_link(POGOSIM_SPRING, 0, 0); },
              "pogosim_world_new_link(): object 0 cannot be linked to itself"},
             {[] {
                  pogosim_link_t link = pogosim_world_new_link(POGOSIM_SPRING, 0, 1);
                  link.stiffness_n_m = -1.0;
                  pogosim_world_add_link(&link);
              },
              "pogosim_world_add_link(): stiffness: expected a number from 0 to 1e+09, found -1"},
             {[] {
                  pogosim_link_t link = pogosim_world_new_link(POGOSIM_ROD, 0, 1);
                  link.a_x_mm = NAN;
                  pogosim_world_add_link(&link);
              },
              "pogosim_world_add_link(): a_x_mm: expected a finite number, found nan"},
             {[] { pogosim_world_object("pucks", 0); },
              "pogosim_world_object(): no object has the category 'pucks'; those of the run: 'robots', 'passive'"},
             {[] { pogosim_world_object("robots", 1); },
              "pogosim_world_object(): there is no object 1 of category 'robots': the run has 1, from 0 to 0"}}) {
        wrong = call;
        use_supervised(idle, idle, [] { wrong(); });
        Simulation simulation(
            testing::test_program(),
            square_scene({robot_at({200, 200}), at(passive_object({.radius_mm = 40.0F}), {300, 700})}), {});
        ASSERT_FALSE(simulation.start());
        auto const failure = simulation.step();
        ASSERT_TRUE(failure) << message;
        EXPECT_TRUE(failure->refused);
        EXPECT_EQ(failure->what, message);
        EXPECT_EQ(failure->code, ExitCode::usage);
    }
}

TEST(Supervisor, MakesReadsAndCutsLinks) {
    static pogosim_link_t found;
    static pogosim_link_state_t state;
    use_supervised(idle, idle, [] {
        if (pogosim_world_time() > 0.0) {
            pogosim_world_cut_link(0);
            return;
        }
        pogosim_link_t link = pogosim_world_new_link(POGOSIM_SPRING, 1, 0);
        link.a_x_mm = 40.0;
        link.stiffness_n_m = 0.5;
        link.breaking_n = 2.0;
        EXPECT_EQ(pogosim_world_add_link(&link), 0U);
        link = pogosim_world_new_link(POGOSIM_HINGE, 0, POGOSIM_ARENA);
        link.most_rad = 0.5;
        EXPECT_EQ(pogosim_world_add_link(&link), 1U);
        EXPECT_EQ(pogosim_world_link_count(), 2U);
        pogosim_world_link(0, &found);
        pogosim_world_link_state(0, &state);
        pogosim_world_link(1, &link);
        EXPECT_EQ(link.b, POGOSIM_ARENA);
        EXPECT_EQ(link.b_x_mm, 200.0);
        EXPECT_EQ(link.most_rad, 0.5);
    });
    Simulation simulation(testing::test_program(),
                          square_scene({robot_at({200, 200}), at(passive_object({.radius_mm = 40.0F}), {300, 200})}),
                          {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(simulation.step());
    EXPECT_EQ(found.kind, POGOSIM_SPRING);
    EXPECT_EQ(found.a, 1U);
    EXPECT_EQ(found.b, 0U);
    EXPECT_EQ(found.a_x_mm, 40.0);
    EXPECT_EQ(found.stiffness_n_m, 0.5);
    EXPECT_EQ(found.breaking_n, 2.0);
    EXPECT_EQ(found.length_mm, state.length_mm);
    EXPECT_FALSE(state.is_cut);
    EXPECT_FALSE(simulation.world().links[0].is_cut);
    ASSERT_FALSE(run_for(simulation, 0.1));
    EXPECT_TRUE(simulation.world().links[0].is_cut);
    EXPECT_FALSE(simulation.world().links[1].is_cut);
    EXPECT_FALSE(simulation.is_touched());
}

TEST(Supervisor, RobotsDoNotSeeTheWorld) {
    use_program(idle, [] { pogosim_world_object_count(); });
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 200})}), {});
    ASSERT_FALSE(simulation.start());
    auto const failure = simulation.step();
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->what,
              "pogosim_world_object_count(): robots do not see the world; call it in callback_global_setup, "
              "callback_global_step, callback_create_data_schema or callback_robot_click");
    EXPECT_EQ(failure->code, ExitCode::usage);
}

}  // namespace
}  // namespace pogosim
