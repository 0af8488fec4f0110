// What user code sees: categories, memory, random numbers, messages, data columns, callbacks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using testing::robot_at;
using testing::robots;
using testing::square_scene;

TEST(Program, MainRunsOncePerRobotAndInitAfterAllMains) {
    static std::vector<char> order;
    order.clear();
    testing::program_main = [] {
        order.push_back('m');
        pogobot_start([] { order.push_back('i'); }, nullptr);
        SET_CALLBACK(callback_global_setup, [] { order.push_back('g'); });
    };
    Simulation simulation(testing::test_program(), square_scene({robots(2)}), {});
    ASSERT_FALSE(simulation.start());
    EXPECT_EQ(order, (std::vector<char>{'m', 'm', 'g', 'i', 'i'}));
}

TEST(Program, EachCategoryRunsTheControllerOfItsName) {
    static std::vector<std::pair<int, std::string>> ran;
    ran.clear();
    testing::program_main = [] {
        pogobot_start([] { ran.emplace_back(0, get_current_robot_category()); }, nullptr);
        pogobot_start([] { ran.emplace_back(1, get_current_robot_category()); }, nullptr, "guards");
        pogobot_start([] { ran.emplace_back(2, get_current_robot_category()); }, nullptr, "nobody");
    };
    Simulation simulation(testing::test_program(),
                          square_scene({robots(1), robots(1, testing::article_robot(), "guards")}), {});
    ASSERT_FALSE(simulation.start());
    EXPECT_EQ(ran, (std::vector<std::pair<int, std::string>>{{0, "robots"}, {1, "guards"}}));
}

TEST(Program, RobotWithoutControllerTicksAllTheSame) {
    testing::program_main = [] {};
    Simulation simulation(testing::test_program(), square_scene({robots(1)}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 1.0));
    EXPECT_NEAR(simulation.controllers().ticks(0), 62, 1);
}

TEST(UserData, IsZeroAtFirstAndEachRobotsOwn) {
    static bool all_zero = true;
    testing::use_program(
        [] {
            all_zero =
                all_zero && std::all_of(mydata->number.begin(), mydata->number.end(), [](auto n) { return n == 0; });
            mydata->number.fill(-1);
            mydata->number[0] = pogobot_helper_getid();
        },
        [] { mydata->number[0] += 100; });
    Simulation simulation(testing::test_program(), square_scene({robots(5)}), {});
    static std::vector<std::int64_t> last;
    last.clear();
    testing::program_main = [main = testing::program_main] {
        main();
        SET_CALLBACK(callback_robot_end, [] { last.push_back(mydata->number[0]); });
    };
    Scenario scenario = square_scene({robots(5)});
    scenario.simulation_time_s = 0.16;
    Simulation run(testing::test_program(), std::move(scenario), {});
    EXPECT_EQ(run.run(), ExitCode::done);
    EXPECT_TRUE(all_zero);
    EXPECT_EQ(last, (std::vector<std::int64_t>{1000, 1001, 1002, 1003, 1004}));
}

TEST(LoopGlobals, AreEachRobotsOwn) {
    testing::use_program([] { main_loop_hz = pogobot_helper_getid() == 0 ? 10 : 40; }, nullptr);
    Simulation simulation(testing::test_program(), square_scene({robots(2)}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 2.0));
    EXPECT_NEAR(simulation.controllers().ticks(0), 20, 1);
    EXPECT_NEAR(simulation.controllers().ticks(1), 80, 1);
}

TEST(RandomNumbers, SeedsDifferOnEveryRobotAndRepeatWithTheRun) {
    static std::vector<int16_t> seeds;
    testing::use_program([] { seeds.push_back(pogobot_helper_getRandSeed()); }, nullptr);
    std::vector<std::vector<int16_t>> runs;
    for (std::uint32_t const seed : {1U, 1U, 2U}) {
        seeds.clear();
        Scenario scenario = square_scene({robots(300)}, 4000.0);
        scenario.seed = seed;
        Simulation simulation(testing::test_program(), std::move(scenario), {});
        ASSERT_FALSE(simulation.start());
        runs.push_back(seeds);
    }
    EXPECT_EQ(runs[0], runs[1]);
    EXPECT_NE(runs[0], runs[2]);
    EXPECT_EQ(std::set<int16_t>(runs[0].begin(), runs[0].end()).size(), 300U);
}

/// The seeds that three robots get, one in each call of init and step; robot 1 takes `extra` more in each.
std::vector<std::vector<int16_t>> seeds_of_three_robots(int extra) {
    static std::vector<std::vector<int16_t>> seeds;
    static int extra_of_robot_1 = 0;
    seeds.assign(3, {});
    extra_of_robot_1 = extra;
    auto const take = [] {
        auto const id = pogobot_helper_getid();
        seeds[id].push_back(pogobot_helper_getRandSeed());
        for (int i = 0; id == 1 && i < extra_of_robot_1; ++i) {
            pogobot_helper_getRandSeed();
        }
    };
    testing::use_program(take, take);
    Simulation simulation(testing::test_program(), square_scene({robots(3)}), {});
    EXPECT_FALSE(simulation.start());
    EXPECT_FALSE(testing::run_for(simulation, 0.3));
    return seeds;
}

TEST(RandomNumbers, SeedsAfterTheFirstDifferBetweenRobotsToo) {
    auto const seeds = seeds_of_three_robots(0);
    ASSERT_GE(seeds[0].size(), 15U);
    for (auto const& [a, b] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
        int equal = 0;
        for (std::size_t i = 0; i < seeds[0].size(); ++i) {
            equal += seeds[a][i] == seeds[b][i] ? 1 : 0;
        }
        EXPECT_LE(equal, 1) << "robots " << a << " and " << b;
    }
    for (auto const& own : seeds) {
        EXPECT_GE(std::set<int16_t>(own.begin(), own.end()).size(), own.size() - 1);
    }
}

TEST(RandomNumbers, SeedThatOneRobotTakesChangesThatOfNoOther) {
    auto const few = seeds_of_three_robots(0);
    auto const many = seeds_of_three_robots(5);
    EXPECT_EQ(few[0], many[0]);
    EXPECT_EQ(few[2], many[2]);
    EXPECT_NE(few[1], many[1]);
}

TEST(RandomNumbers, SrandGivesTheSameNumbersOnEveryRobotAndRandTouchesOnlyItsOwn) {
    static std::vector<std::vector<int>> numbers;
    numbers.assign(3, {});
    testing::use_program([] { srand(42); },
                         [] {
                             // Robot 2 draws more often than the others.
                             for (int i = 0; i <= pogobot_helper_getid() / 2; ++i) {
                                 numbers[pogobot_helper_getid()].push_back(rand());
                             }
                         });
    Simulation simulation(testing::test_program(), square_scene({robots(3)}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 1.0));
    EXPECT_EQ(numbers[0], numbers[1]);
    EXPECT_TRUE(std::equal(numbers[0].begin(), numbers[0].end(), numbers[2].begin()));
    EXPECT_TRUE(std::all_of(numbers[2].begin(), numbers[2].end(), [](int n) { return n >= 0; }));
}

TEST(Leds, UnknownOnesAreIgnored) {
    testing::use_program(
        [] {
            pogobot_led_setColor(1, 2, 3);
            pogobot_led_setColors(4, 5, 6, 4);
            pogobot_led_setColors(7, 8, 9, 5);
        },
        nullptr);
    Simulation simulation(testing::test_program(), square_scene({robots(1)}), {});
    ASSERT_FALSE(simulation.start());
    EXPECT_EQ(simulation.world().robots.led[0], (Leds{Rgb{1, 2, 3}, {}, {}, {}, Rgb{4, 5, 6}}));
}

TEST(Motors, MemoryHoldsDirectionsAndPowersPerRobot) {
    static std::vector<int> seen;
    seen.clear();
    testing::use_program(
        [] {
            uint8_t directions[3];
            uint16_t powers[3];
            seen.push_back(pogobot_motor_dir_mem_get(directions));
            seen.insert(seen.end(), directions, directions + 3);
            seen.push_back(pogobot_motor_power_mem_get(powers));
            seen.insert(seen.end(), powers, powers + 3);
            seen.push_back(static_cast<int>(pogobot_motor_dir_current_status()));
            uint8_t other[3] = {1, 0, 1};
            pogobot_motor_dir_mem_set(other);
            pogobot_motor_dir_mem_get(directions);
            seen.push_back(directions[0]);
            pogobot_motor_dir_set(motorR, 1);
            pogobot_motor_dir_set(static_cast<motor_id>(7), 1);
            seen.push_back(static_cast<int>(pogobot_motor_dir_current_status()));
            seen.push_back(pogobot_motor_dir_mem_get(nullptr));
        },
        nullptr);
    Simulation simulation(testing::test_program(), square_scene({robots(1)}), {});
    ASSERT_FALSE(simulation.start());
    EXPECT_EQ(seen, (std::vector<int>{0, 0, 1, 0, 0, 512, 512, 0, 2, 1, 3, -1}));
}

TEST(Messages, ReachANeighbourInTheStepAfterTheyWereSent) {
    static std::vector<std::pair<int, message_t>> received;
    received.clear();
    testing::use_program(
        [] {
            percent_msgs_sent_per_ticks = pogobot_helper_getid() == 0 ? 100 : 0;
            msg_tx_fn = [] {
                uint8_t text[3] = {'a', 'b', static_cast<uint8_t>(pogobot_ticks)};
                return pogobot_infrared_sendLongMessage_omniGen(text, 3) == 0;
            };
            msg_rx_fn = [](message_t* message) { received.emplace_back(pogobot_ticks, *message); };
        },
        nullptr);
    Simulation simulation(
        testing::test_program(),
        square_scene({robot_at({450, 500}), robot_at({550, 500}, testing::article_robot(), "others")}), {});
    testing::program_main = [main = testing::program_main] {
        main();
        pogobot_start([] { msg_rx_fn = [](message_t* message) { received.emplace_back(pogobot_ticks, *message); }; },
                      nullptr, "others");
    };
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 0.1));
    ASSERT_GE(received.size(), 5U);
    for (std::size_t i = 0; i < received.size(); ++i) {
        auto const& [tick, message] = received[i];
        EXPECT_EQ(message.payload[2], i);          // in order, none lost
        EXPECT_EQ(tick, static_cast<int>(i) + 1);  // sent in tick i, read in the next
        EXPECT_EQ(message.payload[3], 0);          // nothing behind the payload
        EXPECT_EQ(message.header._packet_type, ir_t_user);
        EXPECT_EQ(message.header._sender_id, 0);
        EXPECT_EQ(message.header._sender_ir_index, ir_all);
        EXPECT_EQ(message.header._receiver_ir_index, ir_back);
        EXPECT_EQ(message.header.payload_length, 3);
    }
}

/// Two robots side by side, robot 1 to the right of robot 0, both looking along +x; robot 0 sends once by `send`.
std::vector<message_t> heard_by_the_right_one(void (*send)()) {
    static void (*send_once)() = nullptr;
    static std::vector<message_t> heard;
    send_once = send;
    heard.clear();
    testing::use_program(nullptr, [] {
        if (pogobot_helper_getid() == 0 && pogobot_ticks == 1) {
            send_once();
        }
        while (pogobot_infrared_message_available() != 0) {
            heard.emplace_back();
            pogobot_infrared_recover_next_message(&heard.back());
        }
    });
    Scenario scenario = square_scene({robot_at({500, 450}), robot_at({500, 530})});
    Simulation simulation(testing::test_program(), std::move(scenario), {});
    EXPECT_FALSE(simulation.start());
    EXPECT_FALSE(testing::run_for(simulation, 0.1));
    return heard;
}

uint8_t payload[400] = {42};

TEST(Messages, ShortOnesCarryNoSender) {
    auto const heard = heard_by_the_right_one([] { pogobot_infrared_sendShortMessage_omni(payload, 1); });
    ASSERT_EQ(heard.size(), 1U);
    EXPECT_EQ(heard[0].header._packet_type, ir_t_short);
    EXPECT_EQ(heard[0].header._sender_id, 0xFF);
    EXPECT_EQ(heard[0].header._sender_ir_index, 0xF);
    EXPECT_EQ(heard[0].header._emitting_power_list, 0);
    EXPECT_EQ(heard[0].header._receiver_ir_index, ir_left);
    EXPECT_EQ(heard[0].payload[0], 42);
}

TEST(Messages, DirectedOnesGoToTheirSideOnly) {
    EXPECT_EQ(heard_by_the_right_one([] { pogobot_infrared_sendShortMessage_uni(ir_right, payload, 1); }).size(), 1U);
    EXPECT_TRUE(heard_by_the_right_one([] { pogobot_infrared_sendShortMessage_uni(ir_left, payload, 1); }).empty());
    EXPECT_TRUE(heard_by_the_right_one([] { pogobot_infrared_sendLongMessage_uniSpe(ir_left, payload, 1); }).empty());
    auto const heard = heard_by_the_right_one([] { pogobot_infrared_sendLongMessage_omniSpe(payload, 1); });
    ASSERT_FALSE(heard.empty());
    EXPECT_TRUE(std::all_of(heard.begin(), heard.end(), [](message_t const& m) {
        return m.header._sender_ir_index != ir_all && m.header._sender_ir_index != ir_left;
    }));
}

TEST(Messages, ThroughEachEmitterSayWhichOneHasPower) {
    auto const heard = heard_by_the_right_one([] {
        pogobot_infrared_set_power(2);
        pogobot_infrared_sendLongMessage_omniSpe(payload, 1);
        pogobot_infrared_sendLongMessage_omniGen(payload, 1);
    });
    ASSERT_GT(heard.size(), 1U);
    for (message_t const& message : heard) {
        unsigned const emitter = message.header._sender_ir_index;
        EXPECT_EQ(message.header._emitting_power_list, emitter == ir_all ? 0b10101010U : 2U << (2 * emitter));
    }
    EXPECT_NE(heard.front().header._sender_ir_index, ir_all);
    EXPECT_EQ(heard.back().header._sender_ir_index, ir_all);
}

TEST(Messages, RawOnesGoThroughTheEmittersOfTheirPowerList) {
    auto const right = heard_by_the_right_one([] {
        message_t message = {};
        message.header._emitting_power_list = pogobot_infrared_emitting_power_list(0, 3, 0, 0);
        message.header.payload_length = 2;
        pogobot_infrared_sendRawLongMessage(&message);
    });
    ASSERT_EQ(right.size(), 1U);
    EXPECT_EQ(right[0].header._sender_ir_index, ir_right);
    EXPECT_EQ(right[0].header._emitting_power_list, 3 << 2);
    EXPECT_TRUE(heard_by_the_right_one([] {
                    message_t message = {};
                    message.header._emitting_power_list = pogobot_infrared_emitting_power_list(0, 0, 0, 1);
                    pogobot_infrared_sendRawLongMessage(&message);
                }).empty());
}

TEST(Messages, TooLongOnesAreNotSent) {
    static uint32_t result = 0;
    EXPECT_EQ(heard_by_the_right_one([] { result = pogobot_infrared_sendShortMessage_omni(payload, 382); }).size(), 1U);
    EXPECT_EQ(result, 0U);
    EXPECT_TRUE(heard_by_the_right_one([] { result = pogobot_infrared_sendShortMessage_omni(payload, 383); }).empty());
    EXPECT_EQ(result, 1U);
    EXPECT_TRUE(heard_by_the_right_one([] { result = pogobot_infrared_sendLongMessage_omniGen(nullptr, 3); }).empty());
    EXPECT_EQ(result, 1U);
}

TEST(Messages, PowerZeroSendsNothing) {
    EXPECT_TRUE(heard_by_the_right_one([] {
                    pogobot_infrared_set_power(0);
                    pogobot_infrared_sendShortMessage_omni(payload, 1);
                }).empty());
}

TEST(Messages, OnlySoManyAreProcessedPerTickAndTheRestIsDropped) {
    static int handled = 0;
    handled = 0;
    testing::use_program(
        [] {
            max_nb_processed_msg_per_tick = 2;
            if (pogobot_helper_getid() == 1) {
                msg_rx_fn = [](message_t*) { ++handled; };
            }
        },
        [] {
            if (pogobot_helper_getid() == 0 && pogobot_ticks == 0) {
                for (int i = 0; i < 5; ++i) {
                    pogobot_infrared_sendShortMessage_omni(payload, 1);
                }
            }
        });
    Simulation simulation(testing::test_program(), square_scene({robot_at({450, 500}), robot_at({530, 500})}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 1.0));
    EXPECT_EQ(handled, 2);
}

TEST(GlobalStep, RunsInItsOwnContextSixtyTimesASecond) {
    static int calls = 0;
    static std::string category;
    static int nb_robots = 0;
    calls = 0;
    testing::program_main = [] {
        pogobot_start([] { mydata->number[0] = 7; }, nullptr);
        SET_CALLBACK(callback_global_step, [] {
            ++calls;
            category = get_current_robot_category();
            nb_robots = static_cast<int>(get_nb_robots());
            EXPECT_EQ(mydata->number[0], calls - 1);
            mydata->number[0] = calls;
            if (calls == 50) {
                stop_simulation();
            }
        });
    };
    Simulation simulation(testing::test_program(), square_scene({robots(3)}), {});
    EXPECT_EQ(simulation.run(), ExitCode::done);
    EXPECT_EQ(calls, 50);
    EXPECT_EQ(category, "__system");
    EXPECT_EQ(nb_robots, 3);
    EXPECT_NEAR(simulation.world().time_s(), 50 * 0.016, 0.02);
}

}  // namespace
}  // namespace pogosim
