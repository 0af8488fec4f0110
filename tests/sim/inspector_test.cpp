// What the window shows of single robots.
#include "sim/inspector.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lamps/spot_lamp.hpp"
#include "support/objects.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using namespace testing;

void idle() {}

void full_ahead_later() {
    if (pogobot_ticks == 4) {
        pogobot_motor_set(motorL, motorFull);
        pogobot_motor_set(motorR, motorFull);
    }
}

void start(Simulation& simulation) {
    ASSERT_FALSE(simulation.start());
}

std::optional<std::string> cell(Inspection const& inspection, std::string const& column) {
    for (auto const& [name, value] : inspection.columns) {
        if (name == column) {
            return value;
        }
    }
    return std::nullopt;
}

TEST(Inspector, ShowsPoseSpeedAndMotors) {
    use_program(idle, [] {
        pogobot_motor_set(motorL, 1023);
        pogobot_motor_set(motorR, 511);
        pogobot_led_setColors(1, 2, 3, 4);
    });
    Simulation simulation(testing::test_program(), square_scene({robot_at({500, 500})}), {});
    simulation.inspector();
    start(simulation);
    for (int i = 0; i < 50; ++i) {
        ASSERT_FALSE(simulation.step());
        simulation.inspector().note_step();
    }
    Inspection const robot = simulation.inspector().inspect(0);
    World const& world = simulation.world();
    EXPECT_EQ(robot.robot, 0U);
    EXPECT_EQ(robot.id, 0);
    EXPECT_EQ(robot.category, "robots");
    EXPECT_TRUE(robot.has_body);
    EXPECT_EQ(robot.position_mm, world.bodies.position_mm[0]);
    EXPECT_EQ(robot.heading_rad, world.bodies.heading_rad[0]);
    EXPECT_NEAR(robot.speed_mm_s, 75.0F * std::sin(0.16F) / 0.16F, 0.1F);  // along the chord of its circle
    EXPECT_NEAR(robot.angular_velocity_rad_s, 2.0F, 0.01F);
    EXPECT_EQ(robot.ticks, 31U);  // 62.5 per second, the first at t = 0
    EXPECT_NEAR(robot.clock_s, 0.496, 1e-9);
    EXPECT_EQ(robot.motor_power, (std::array<int, 3>{511, 1023, 0}));
    EXPECT_EQ(robot.motor_direction, (std::array<int, 3>{0, 1, 0}));
    EXPECT_EQ(robot.led[4], (Rgb{1, 2, 3}));
}

TEST(Inspector, ShowsTheTensionsOfItsLinks) {
    use_program(idle, idle);
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 500}), robot_at({300, 500})}), {});
    Inspector& inspector = simulation.inspector();
    EXPECT_EQ(inspector.inspect(0).links, 0U);
    World& world = simulation.world();
    auto const add = [&world](std::uint32_t a, std::uint32_t b, float tension_n) {
        Link link;
        link.a = a;
        link.b = b;
        link.tension_n = tension_n;
        world.links.push_back(link);
    };
    add(0, 1, 0.5F);
    add(0, kNone, 0.25F);
    add(1, kNone, -1.0F);
    add(1, 0, 9.0F);
    world.links.back().is_cut = true;
    Inspection const inspection = inspector.inspect(0);
    EXPECT_EQ(inspection.links, 2U);
    EXPECT_EQ(inspection.least_tension_n, 0.25F);
    EXPECT_EQ(inspection.most_tension_n, 0.5F);
    EXPECT_EQ(inspector.inspect(1).least_tension_n, -1.0F);
}

TEST(Inspector, ShowsLightWithoutBiasAndNoise) {
    SpotSpec left_to_right;
    left_to_right.shape.kind = ShapeKind::global;
    left_to_right.mode = LightMode::plane;
    left_to_right.value = 0;
    left_to_right.edge_value = 1000;
    left_to_right.centre_mm = {500, 500};
    left_to_right.plane_half_span_mm = 500.0F;
    ObjectSpec spec = article_robot();
    spec.robot->photosensor_bias = {100, 200};
    spec.robot->photosensor_noise_stddev = 50.0F;
    use_program(idle, idle);
    Simulation simulation(testing::test_program(), square_scene({robot_at({500, 500}, spec), lamp(left_to_right)}), {});
    start(simulation);
    auto const light = simulation.inspector().inspect(0).light;
    EXPECT_NEAR(light[0], 500 - 26.5, 6);
    EXPECT_NEAR(light[1], 500 + 0.766 * 26.5, 6);
    EXPECT_EQ(light[1], light[2]);
    EXPECT_EQ(simulation.inspector().inspect(0).light, light);
}

TEST(Inspector, ShowsAccelerationAlongTheRobotsAxes) {
    use_program(idle, full_ahead_later);
    Simulation simulation(testing::test_program(), square_scene({robot_at({500, 500})}), {});
    start(simulation);
    while (simulation.controllers().ticks(0) < 6) {  // the fifth tick starts the motors, the sixth measures
        ASSERT_FALSE(simulation.step());
    }
    Vec2 const acceleration = simulation.inspector().inspect(0).acceleration_m_s2;
    EXPECT_NEAR(acceleration.x, 0.1F / 0.016F, 0.05F);
    EXPECT_NEAR(acceleration.y, 0.0F, 1e-3F);
}

TEST(Inspector, ListsTheRobotsThatHearIt) {
    use_program(idle, idle);
    Simulation simulation(
        testing::test_program(),
        square_scene({robot_at({500, 500}), robot_at({600, 500}), robot_at({500, 420}), robot_at({900, 900})}), {});
    start(simulation);
    auto const neighbours = simulation.inspector().inspect(0).neighbours;
    ASSERT_EQ(neighbours.size(), 2U);
    EXPECT_EQ(neighbours[0].id, 1);
    EXPECT_EQ(neighbours[0].category, "robots");
    EXPECT_EQ(neighbours[0].emitters, 1);
    EXPECT_NEAR(neighbours[0].distance_mm, 100 - 26.5F, 0.01F);
    EXPECT_EQ(neighbours[1].id, 2);
    EXPECT_EQ(neighbours[1].emitters, 8);
    EXPECT_NEAR(neighbours[1].distance_mm, 80 - 26.5F, 0.01F);
}

TEST(Inspector, WallHearsAndIsHeardAtTheDistanceOfItsOutline) {
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "robots");
        pogobot_start(idle, idle, "walls");
    };
    Simulation simulation(testing::test_program(), square_scene({robot_at({940, 500}), arena_wall()}), {});
    start(simulation);
    auto const of_robot = simulation.inspector().inspect(0);
    auto const of_wall = simulation.inspector().inspect(1);
    ASSERT_EQ(of_robot.neighbours.size(), 1U);
    EXPECT_EQ(of_robot.neighbours[0].category, "walls");
    EXPECT_NEAR(of_robot.neighbours[0].distance_mm, 60 - 26.5F, 0.05F);
    EXPECT_FALSE(of_wall.has_body);
    ASSERT_EQ(of_wall.neighbours.size(), 1U);
    EXPECT_EQ(of_wall.neighbours[0].id, 0);
    EXPECT_NEAR(of_wall.neighbours[0].distance_mm, 60 - 26.5F, 0.05F);
}

TEST(Inspector, MembraneIsWhereItsMiddleIs) {
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "membranes");
    };
    Simulation simulation(testing::test_program(), square_scene({at(membrane(), {480, 520})}), {});
    start(simulation);
    Inspection const membrane = simulation.inspector().inspect(0);
    EXPECT_TRUE(membrane.has_body);
    EXPECT_NEAR(membrane.position_mm.x, 480, 0.1F);
    EXPECT_NEAR(membrane.position_mm.y, 520, 0.1F);
}

TEST(Inspector, CountsMessages) {
    use_program([] { msg_rx_fn = [](message_t*) {}; },
                [] {
                    if (pogobot_ticks < 10 && pogobot_helper_getid() == 0) {
                        std::uint8_t byte = 1;
                        pogobot_infrared_sendShortMessage_omni(&byte, 1);
                        pogobot_infrared_sendShortMessage_uni(ir_front, &byte, 1);
                    }
                });
    Simulation simulation(testing::test_program(), square_scene({robot_at({500, 500}), robot_at({600, 500})}), {});
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 1.0));
    Inspection const sender = simulation.inspector().inspect(0);
    Inspection const receiver = simulation.inspector().inspect(1);
    EXPECT_EQ(sender.messages_sent, 20U);
    EXPECT_EQ(sender.messages_received, 0U);
    EXPECT_EQ(receiver.messages_sent, 0U);
    EXPECT_EQ(receiver.messages_received, 20U);
    EXPECT_EQ(receiver.messages_waiting, 0U);
}

TEST(Inspector, KeepsTheLastTwentyLinesOfARobot) {
    use_program(idle, [] {
        if (pogobot_helper_getid() == 1) {
            pogosim_printf("tick %lu\nhalf a line", static_cast<unsigned long>(pogobot_ticks));
            pogosim_printf(" and its end\n");
        }
    });
    Simulation simulation(testing::test_program(), square_scene({robot_at({300, 500}), robot_at({600, 500})}), {});
    Inspector& inspector = simulation.inspector();
    start(simulation);
    EXPECT_TRUE(inspector.inspect(1).lines.empty());
    while (simulation.controllers().ticks(1) < 30) {
        ASSERT_FALSE(simulation.step());
    }
    auto const lines = inspector.inspect(1).lines;
    ASSERT_EQ(lines.size(), 20U);
    EXPECT_EQ(lines.front(), "tick 20");
    EXPECT_EQ(lines[18], "tick 29");
    EXPECT_EQ(lines[19], "half a line and its end");
    EXPECT_TRUE(inspector.inspect(0).lines.empty());
}

TEST(PrintedLines, AreCutBetweenCharactersAndMadeWellFormed) {
    PrintedLines lines(1);
    std::string accents;
    for (int i = 0; i < 300; ++i) {
        accents += "\u00e9";
    }
    lines.add(0, accents);
    EXPECT_EQ(lines.of(0).back(), accents.substr(0, 400));
    lines.add(0, "bad \xff byte");
    EXPECT_EQ(lines.of(0).back(), "bad \uFFFD byte");
    lines.add(0, "");
    EXPECT_EQ(lines.of(0).back(), "");
    lines.add(0, std::string(100000, 'x'));
    EXPECT_EQ(lines.of(0).back(), std::string(200, 'x'));
}

/// A program that exports a value of each kind.
void use_exporting_program() {
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "robots");
        callback_create_data_schema = [] {
            data_add_column_int32("age");
            data_add_column_string("name");
            data_add_column_double("share");
            data_add_column_bool("happy");
        };
        callback_export_data = [] {
            data_set_value_int32("age", static_cast<std::int32_t>(pogobot_ticks));
            data_set_value_string("name", "R\xff");
            if (pogobot_helper_getid() == 0) {
                data_set_value_double("share", 0.25);
            }
            data_set_value_bool("happy", true);
            if (pogobot_helper_getid() == 2) {
                disable_data_export();
            }
        };
    };
}

Scenario recorded_scene(TemporaryFolder const& folder, std::string const& name = "data.feather") {
    Scenario scenario = square_scene({robot_at({300, 500}), robot_at({600, 500}), robot_at({800, 500}),
                                      at(passive_object({.radius_mm = 20.0F}), {500, 800})});
    scenario.output.enable_data_logging = true;
    scenario.output.data_filename = folder / name;
    scenario.output.save_data_period_s = 0.1;
    return scenario;
}

TEST(Inspector, ShowsTheLastRowOfTheDataFile) {
    TemporaryFolder const folder;
    use_exporting_program();
    Simulation simulation(testing::test_program(), recorded_scene(folder), {});
    Inspector& inspector = simulation.inspector();
    EXPECT_TRUE(inspector.inspect(0).columns.empty());
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 0.15));
    Inspection const first = inspector.inspect(0);
    std::vector<std::pair<std::string, std::string>> const expected{
        {"pogobot_ticks", "6"}, {"x", "300"},        {"y", "500"},      {"angle", "0"},
        {"age", "6"},           {"name", "R\uFFFD"}, {"share", "0.25"}, {"happy", "true"}};
    EXPECT_EQ(first.columns, expected);
    EXPECT_NEAR(first.columns_time_s, 0.1, 1e-6);
    EXPECT_EQ(cell(inspector.inspect(1), "share"), "null");
    EXPECT_TRUE(inspector.inspect(2).columns.empty());  // its rows are not exported
    simulation.finish();
}

TEST(Inspector, ShowsUserDataByNameAsTheyAreNow) {
    use_program(idle, [] { static_cast<TestData*>(mydata)->number[2] = static_cast<std::int64_t>(pogobot_ticks); });
    Simulation simulation(testing::test_program(), square_scene({robot_at({300, 500}), robot_at({600, 500})}), {});
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 0.1));
    Inspection const robot = simulation.inspector().inspect(1);
    if (robot.variables.empty()) {
        EXPECT_NE(robot.no_variables, "");  // built without debug information
        return;
    }
    ASSERT_EQ(robot.variables.size(), 1U);
    EXPECT_EQ(robot.variables[0].first, "number");
    EXPECT_EQ(robot.variables[0].second, "0, 0, 5, 0, 0, 0, 0, 0");
}

TEST(RecordedRows, HandOutTheNumbersOfEachRecordedTimeOnce) {
    TemporaryFolder const folder;
    use_exporting_program();
    Simulation simulation(testing::test_program(), recorded_scene(folder), {});
    RecordedRows& rows = simulation.inspector().rows();
    start(simulation);
    EXPECT_EQ(rows.columns(), (std::vector<std::string>{"pogobot_ticks", "x", "y", "angle", "age", "share", "happy"}));
    auto const at_start = rows.take();
    ASSERT_EQ(at_start.size(), 1U);
    EXPECT_EQ(at_start[0].time_s, 0.0);
    EXPECT_EQ(at_start[0].robot, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_TRUE(rows.take().empty());
    ASSERT_FALSE(run_for(simulation, 0.25));
    auto const later = rows.take();
    ASSERT_EQ(later.size(), 2U);
    EXPECT_DOUBLE_EQ(later[1].time_s, 0.2);
    ASSERT_EQ(later[1].values.size(), 7U);
    EXPECT_EQ(later[1].values[1], (std::vector<float>{300, 600}));
    EXPECT_EQ(later[1].values[4], later[1].values[0]);
    EXPECT_EQ(later[1].values[5][0], 0.25F);
    EXPECT_TRUE(std::isnan(later[1].values[5][1]));
    EXPECT_EQ(later[1].values[6], (std::vector<float>{1, 1}));
    simulation.finish();
}

TEST(RecordedRows, HaveTheColumnsOfTheFileAlone) {
    TemporaryFolder const folder;
    use_exporting_program();
    Scenario scenario = recorded_scene(folder);
    scenario.output.fields = {"x", "share", "name"};
    Simulation simulation(testing::test_program(), scenario, {});
    start(simulation);
    RecordedRows& rows = simulation.inspector().rows();  // asked for when the file is open already
    EXPECT_EQ(rows.columns(), (std::vector<std::string>{"x", "share"}));
    ASSERT_FALSE(run_for(simulation, 0.15));
    EXPECT_EQ(rows.take().size(), 1U);
    EXPECT_EQ(cell(simulation.inspector().inspect(0), "name"), "R\uFFFD");
    EXPECT_EQ(cell(simulation.inspector().inspect(0), "y"), std::nullopt);
    simulation.finish();
}

TEST(Inspector, ChangesNoByteOfTheDataFile) {
    TemporaryFolder const folder;
    auto const run = [&folder](std::string const& name, bool inspected) {
        use_exporting_program();
        Scenario scenario = recorded_scene(folder, name);
        scenario.objects[0].spec.robot->photosensor_noise_stddev = 10.0F;
        Simulation simulation(testing::test_program(), scenario, {});
        if (inspected) {
            simulation.inspector();
        }
        EXPECT_FALSE(simulation.start());
        for (int i = 0; i < 100; ++i) {
            EXPECT_FALSE(simulation.step());
            if (inspected) {
                simulation.inspector().inspect(static_cast<std::uint32_t>(i % 3));
                simulation.inspector().rows().take();
            }
        }
        simulation.finish();
        std::ifstream file(folder / name, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    std::string const plain = run("data.feather", false);
    std::string const inspected = run("data.feather", true);
    EXPECT_GT(plain.size(), 1000U);
    EXPECT_EQ(plain, inspected);
}

}  // namespace
}  // namespace pogosim
