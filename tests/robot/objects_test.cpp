// Programs on every type of object: whose controller runs where, ids, callbacks, infrared of walls and bodies, motors.
#include "support/objects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "config/config_file.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using testing::active_object;
using testing::arena_wall;
using testing::at;
using testing::membrane;
using testing::passive_object;
using testing::pogobject;
using testing::robot_at;
using testing::square_scene;

constexpr Shape kDisk{.kind = ShapeKind::disk, .radius_mm = 40.0F};
constexpr Shape kBar{.kind = ShapeKind::rectangle, .width_mm = 60.0F, .height_mm = 80.0F};

/// One category of each type, away from each other, in a square of 2 m.
Scenario one_of_each() {
    ObjectConfig pair = passive_object(kDisk);
    pair.nb = 2;
    ObjectConfig first = testing::robots(2);
    return square_scene({first, arena_wall(), at(pogobject(), {300, 300}), at(membrane(), {1000, 500}), pair,
                         at(active_object(kBar), {1700, 1500}), at(membrane(true, "rectmembranes"), {1000, 1500}),
                         robot_at({300, 1500}, first.spec, "late")},
                        2000.0);
}

std::vector<std::string> const kCategories{"robots", "walls",         "pogobjects", "membranes",
                                           "active", "rectmembranes", "late"};

TEST(Categories, IdsGoUpFromZeroForRobotsAndDownFrom65535ForAllElse) {
    testing::program_main = nullptr;
    config_file::Warnings const idle;
    Simulation const simulation(testing::test_program(), one_of_each(), {});
    std::vector<int> ids;
    std::vector<std::string> names;
    for (Object const& object : simulation.world().objects) {
        ids.push_back(object.id);
        names.push_back(simulation.world().categories[object.category].name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"robots", "robots", "walls", "pogobjects", "membranes", "passive",
                                               "passive", "active", "rectmembranes", "late"}));
    EXPECT_EQ(ids, (std::vector<int>{0, 1, 65535, 2, 65534, 65533, 65532, 3, 65531, 4}));
}

TEST(Categories, EachRunsTheControllerOfItsName) {
    static std::map<std::string, std::vector<int>> inits;
    static std::map<std::string, int> steps;
    static std::set<int> counts;
    inits.clear();
    steps.clear();
    counts.clear();
    testing::program_main = [] {
        for (std::string const& category : kCategories) {
            _pogobot_start(
                [] {
                    inits[get_current_robot_category()].push_back(pogobot_helper_getid());
                    counts.insert(static_cast<int>(get_nb_robots()));
                },
                [] { ++steps[get_current_robot_category()]; }, category.c_str());
        }
    };
    Simulation simulation(testing::test_program(), one_of_each(), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 1.6));
    EXPECT_EQ(inits, (std::map<std::string, std::vector<int>>{{"robots", {0, 1}},
                                                              {"walls", {65535}},
                                                              {"pogobjects", {2}},
                                                              {"membranes", {65534}},
                                                              {"active", {3}},
                                                              {"rectmembranes", {65531}},
                                                              {"late", {4}}}));
    for (auto const& [category, count] : steps) {
        EXPECT_NEAR(count, category == "robots" ? 200 : 100, 2) << category;
    }
    EXPECT_EQ(counts, std::set<int>{8});  // all but the passive ones
}

TEST(Categories, WallsAndOtherThingsWithoutWheelsNeedNoProgram) {
    testing::use_program(nullptr, nullptr);
    config_file::Warnings const warnings;
    Simulation simulation(testing::test_program(), one_of_each(), {});
    ASSERT_FALSE(simulation.start());
    EXPECT_EQ(warnings.text(),
              "the program has no pogobot_start() for category 'late' (only for robots); its robots will do nothing\n");
    EXPECT_FALSE(testing::run_for(simulation, 0.1));
}

TEST(Categories, GlobalStepSeesAllRobotsAndHasDataOfItsOwn) {
    static std::set<std::string> categories;
    static std::set<int> counts;
    categories.clear();
    counts.clear();
    testing::program_main = [] {
        for (std::string const& category : kCategories) {
            _pogobot_start([] { mydata->number[0] = 7; }, [] { EXPECT_EQ(mydata->number[0], 7); }, category.c_str());
        }
        SET_CALLBACK(callback_global_step, [] {
            categories.insert(get_current_robot_category());
            counts.insert(static_cast<int>(get_nb_robots()));
            EXPECT_TRUE(current_robot_category_is("__system"));
            EXPECT_EQ(mydata->number[0], mydata->number[1]);
            mydata->number[0] = ++mydata->number[1];
        });
    };
    Simulation simulation(testing::test_program(), one_of_each(), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 0.5));
    EXPECT_EQ(categories, std::set<std::string>{"__system"});
    EXPECT_EQ(counts, std::set<int>{8});
}

TEST(Categories, RobotEndIsCalledOnceForEveryRobotWallAndMembrane) {
    static std::vector<int> ended;
    ended.clear();
    testing::program_main = [] {
        for (std::string const& category : kCategories) {
            _pogobot_start(nullptr, nullptr, category.c_str());
        }
        SET_CALLBACK(callback_robot_end, [] { ended.push_back(pogobot_helper_getid()); });
    };
    Scenario scenario = one_of_each();
    scenario.simulation_time_s = 0.1;
    Simulation simulation(testing::test_program(), std::move(scenario), {});
    EXPECT_EQ(simulation.run(), ExitCode::done);
    EXPECT_EQ(ended, (std::vector<int>{0, 1, 65535, 2, 65534, 3, 65531, 4}));
}

TEST(Walls, AreNotMadeInAPeriodicArena) {
    testing::use_program(nullptr, [] { EXPECT_EQ(get_nb_robots(), 2U); });
    config_file::Warnings const warnings;
    Scenario scenario = square_scene({arena_wall(), robot_at({100, 100}), robot_at({300, 100})});
    scenario.boundary = BoundaryCondition::periodic;
    Simulation simulation(testing::test_program(), std::move(scenario), {});
    EXPECT_EQ(warnings.text(), "objects.walls: a periodic arena has no walls, so no pogowall is created\n");
    ASSERT_FALSE(simulation.start());
    EXPECT_FALSE(testing::run_for(simulation, 0.1));
    EXPECT_EQ(simulation.world().objects.size(), 2U);
}

/// What robot 0 received.
std::vector<message_t> heard;

void listen() {
    while (pogobot_infrared_message_available() != 0) {
        message_t message;
        pogobot_infrared_recover_next_message(&message);
        if (pogobot_helper_getid() == 0) {
            heard.push_back(message);
        }
    }
}

TEST(Walls, DefaultControllerSaysWallToRobotsNearby) {
    heard.clear();
    static std::vector<message_t> far;
    far.clear();
    testing::program_main = [] {
        pogobot_start(nullptr, listen);
        pogobot_start(default_walls_user_init, default_walls_user_step, "walls");
        pogobot_start(
            nullptr, [] { EXPECT_FALSE(pogobot_infrared_message_available()); }, "far");
    };
    // Only the front of robot 0 is within 80 mm of the wall.
    Simulation simulation(
        testing::test_program(),
        square_scene({robot_at({910, 500}), arena_wall(), robot_at({500, 500}, testing::article_robot(), "far")}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 40.0));
    // 400 ticks, at 75 % of which the wall sends: 300 +- 9.
    EXPECT_NEAR(static_cast<double>(heard.size()), 300.0, 35.0);
    for (message_t const& message : heard) {
        ASSERT_EQ(message.header.payload_length, 5);
        ASSERT_STREQ(reinterpret_cast<char const*>(message.payload), "wall");
        ASSERT_EQ(message.header._packet_type, ir_t_user);
        ASSERT_EQ(message.header._sender_id, 65535);
        ASSERT_EQ(message.header._sender_ir_index, ir_front);
        ASSERT_EQ(message.header._receiver_ir_index, ir_front);
    }
}

TEST(Walls, OneTransmissionGivesOneCopyForEachFaceInRange) {
    // 13.5 mm from the wall with its front, so that all four faces are within 80 mm.
    for (bool const one_by_one : {false, true}) {
        heard.clear();
        static bool separately = false;
        separately = one_by_one;
        testing::program_main = [] {
            pogobot_start(nullptr, listen);
            pogobot_start(
                nullptr,
                [] {
                    uint8_t text[1] = {9};
                    if (pogobot_ticks == 0) {
                        separately ? pogobot_infrared_sendLongMessage_omniSpe(text, 1)
                                   : pogobot_infrared_sendLongMessage_omniGen(text, 1);
                    }
                },
                "walls");
        };
        Simulation simulation(testing::test_program(), square_scene({robot_at({960, 500}), arena_wall()}), {});
        ASSERT_FALSE(simulation.start());
        ASSERT_FALSE(testing::run_for(simulation, 0.2));
        ASSERT_EQ(heard.size(), 4U);
        for (std::size_t face = 0; face < 4; ++face) {
            EXPECT_EQ(heard[face].header._receiver_ir_index, face);
            EXPECT_EQ(heard[face].header._sender_ir_index, one_by_one ? ir_front : ir_all);
        }
    }
}

TEST(Walls, ReceiveAtIndexZeroWhatRobotsSayNearby) {
    static std::vector<std::array<int, 3>> at_wall;
    at_wall.clear();
    testing::program_main = [] {
        pogobot_start(nullptr, [] {
            uint8_t text[1] = {9};
            if (pogobot_ticks == 0) {
                pogobot_infrared_sendLongMessage_omniSpe(text, 1);
            }
        });
        pogobot_start(
            [] {
                msg_rx_fn = [](message_t* message) {
                    at_wall.push_back({message->header._sender_id, message->header._sender_ir_index,
                                       message->header._receiver_ir_index});
                };
            },
            nullptr, "walls");
    };
    // Robot 0 in the lower right corner: its front and right emitters see the wall; robot 1 is far from it.
    Simulation simulation(testing::test_program(),
                          square_scene({robot_at({910, 910}), robot_at({500, 500}), arena_wall()}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 0.2));
    EXPECT_EQ(at_wall, (std::vector<std::array<int, 3>>{{0, ir_front, 0}, {0, ir_right, 0}}));
}

/// Ids of those who hear object 0 send once to all sides, at this power.
std::vector<int> hearers(std::vector<ObjectConfig> objects, int power = 3) {
    static std::set<int> ids;
    static int sending_power = 3;
    ids.clear();
    sending_power = power;
    testing::program_main = [] {
        char const* const category = get_current_robot_category();
        _pogobot_start(
            [] {
                pogobot_infrared_set_power(static_cast<uint8_t>(sending_power));
                msg_rx_fn = [](message_t*) { ids.insert(pogobot_helper_getid()); };
            },
            [] {
                uint8_t text[1] = {9};
                if (pogobot_helper_getid() == 0 && pogobot_ticks == 0) {
                    pogobot_infrared_sendShortMessage_omni(text, 1);
                }
            },
            category);
    };
    Simulation simulation(testing::test_program(), square_scene(std::move(objects), 2000.0), {});
    EXPECT_FALSE(simulation.start());
    EXPECT_FALSE(testing::run_for(simulation, 0.2));
    return {ids.begin(), ids.end()};
}

TEST(Infrared, OfAPogobjectComesFromItsCentre) {
    // Its body of 80 mm takes up the whole reach of 80 mm: only the receiver's own radius is left.
    EXPECT_EQ(hearers({at(pogobject(), {1000, 1000}), robot_at({1000.0F + 106.4F, 1000}),
                       robot_at({1000, 1000.0F + 106.6F}), robot_at({1000, 1000.0F - 106.4F})}),
              (std::vector<int>{1, 3}));
}

TEST(Infrared, OfAnActiveObjectComesFromTheRimOfItsBoundingDisk) {
    // Half diagonal 50 mm, reach 80 mm, receiver's radius 26.5 mm.
    EXPECT_EQ(hearers({at(active_object(kBar), {1000, 1000}), robot_at({1000.0F + 156.4F, 1000}),
                       robot_at({1000, 1000.0F + 156.6F}), robot_at({1000, 1000.0F - 156.4F})}),
              (std::vector<int>{1, 3}));
}

TEST(Infrared, ReachFollowsThePowerWhenTheConfigurationSaysSo) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->ir.range_by_power_mm = {20.0F, 50.0F, 200.0F};
    std::vector<ObjectConfig> const objects{robot_at({1000, 1000}, spec), robot_at({1070, 1000}, spec),
                                            robot_at({1000, 1100}, spec), robot_at({1000, 800}, spec)};
    EXPECT_EQ(hearers(objects, 0), std::vector<int>{});
    EXPECT_EQ(hearers(objects, 1), std::vector<int>{1});
    EXPECT_EQ(hearers(objects, 2), (std::vector<int>{1, 2}));
    EXPECT_EQ(hearers(objects, 3), (std::vector<int>{1, 2, 3}));
}

TEST(Infrared, PowersOneToThreeReachEquallyFarByDefault) {
    std::vector<ObjectConfig> const objects{robot_at({1000, 1000}), robot_at({1130, 1000}), robot_at({1000, 1140})};
    for (int const power : {1, 2, 3}) {
        EXPECT_EQ(hearers(objects, power), std::vector<int>{1}) << power;
    }
    EXPECT_EQ(hearers(objects, 0), std::vector<int>{});
}

/// All that have motors to set drive ahead.
void all_ahead() {
    testing::program_main = [] {
        _pogobot_start(
            [] {
                pogobot_motor_set(motorL, motorFull);
                pogobot_motor_set(motorR, motorFull);
            },
            nullptr, get_current_robot_category());
    };
}

TEST(Motors, OfAllButRobotsAreInert) {
    all_ahead();
    Simulation simulation(testing::test_program(),
                          square_scene({at(pogobject(), {500, 200}), at(active_object(kBar), {500, 500}),
                                        at(membrane(), {500, 1000}), arena_wall(), robot_at({100, 1800})},
                                       2000.0),
                          {});
    std::vector<Vec2> const before = simulation.world().bodies.position_mm;
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 2.0));
    std::vector<Vec2> const& after = simulation.world().bodies.position_mm;
    for (std::size_t i = 0; i + 1 < before.size(); ++i) {
        EXPECT_LT(length(after[i] - before[i]), 0.1F) << i;
    }
    EXPECT_NEAR(after.back().x - before.back().x, 200.0F, 0.5F);
}

TEST(Pushing, RobotTakesWhatStandsInItsWayAlongAtItsSpeed) {
    for (ObjectConfig const& object : {passive_object(kDisk), passive_object(kBar), active_object(kDisk),
                                       active_object(kBar), at(pogobject(), {})}) {
        all_ahead();
        ObjectConfig heavy = at(object, {400, 1000});
        heavy.spec.body->linear_damping = 1.0F;  // so that it does not fly off
        heavy.spec.body->restitution = 0.0F;
        ObjectSpec robot = testing::article_robot();
        robot.body->restitution = 0.0F;
        Simulation simulation(testing::test_program(), square_scene({robot_at({200, 1000}, robot), heavy}, 2000.0), {});
        ASSERT_FALSE(simulation.start());
        ASSERT_FALSE(testing::run_for(simulation, 5.0));
        Bodies const& bodies = simulation.world().bodies;
        float const reach_mm = object.spec.shape.kind == ShapeKind::rectangle ? 30.0F : object.spec.shape.radius_mm;
        float const gap_mm = bodies.position_mm[1].x - bodies.position_mm[0].x - 26.5F - reach_mm;
        EXPECT_NEAR(gap_mm, 0.0F, 3.0F) << object.type;
        // At each tick of 16 ms the robot's momentum at full speed is shared; in between damping takes its part.
        Shape const& shape = object.spec.shape;
        float const area_mm2 = shape.kind == ShapeKind::rectangle
                                   ? shape.width_mm * shape.height_mm
                                   : std::numbers::pi_v<float> * shape.radius_mm * shape.radius_mm;
        float const mass = area_mm2 / (std::numbers::pi_v<float> * 26.5F * 26.5F);  // in robots
        EXPECT_NEAR(bodies.velocity_mm_s[1].x, 100.0F / (1.0F + mass * 0.016F), 2.0F) << object.type;
        EXPECT_NEAR(bodies.position_mm[1].y, 1000.0F, 5.0F) << object.type;
    }
}

TEST(Motion, StrongDampingSlowsARobotBetweenItsTicks) {
    // At 10 Hz the speed is imposed every tenth step of 10 ms, and decays exponentially in between.
    testing::use_program(
        [] {
            main_loop_hz = 10;
            pogobot_motor_set(motorL, motorFull);
            pogobot_motor_set(motorR, motorFull);
        },
        nullptr);
    ObjectSpec spec = testing::article_robot();
    spec.body->linear_damping = 20.0F;
    Simulation simulation(testing::test_program(), square_scene({robot_at({500, 500}, spec)}, 2000.0), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 5.0));
    float const per_tick_mm = 100.0F / 20.0F * (1.0F - std::exp(-2.0F));
    EXPECT_NEAR(simulation.world().bodies.position_mm[0].x, 500.0F + 50.0F * per_tick_mm, 0.05F);
}

/// Their ids are the largest there are: the multiplication that scatters seeds must not overflow.
TEST(Walls, GetARandomSeedInEveryRun) {
    static std::set<int16_t> seeds;
    seeds.clear();
    testing::program_main = [] {
        _pogobot_start([] { seeds.insert(pogobot_helper_getRandSeed()); }, nullptr, "walls");
    };
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        Scenario scenario = square_scene({arena_wall()});
        scenario.seed = seed;
        Simulation simulation(testing::test_program(), std::move(scenario), {});
        ASSERT_FALSE(simulation.start());
    }
    EXPECT_GT(seeds.size(), 15U);
}

}  // namespace
}  // namespace pogosim
