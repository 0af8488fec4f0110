// Runs whose robots are driven by a program, a host or a script.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

ObjectSpec driven_by(BrainSpec const& brain) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->linear_noise_stddev = 0.1F;
    spec.robot->angular_noise_stddev = 0.2F;
    spec.robot->motor_bias = {.min = -30, .max = 30};
    spec.robot->clock_drift_stddev_us = 40.0F;
    spec.robot->brain = brain;
    return spec;
}

std::unique_ptr<Simulation> simulation_of(ProgramImage program, std::vector<ObjectConfig> objects) {
    auto simulation = std::make_unique<Simulation>(std::move(program),
                                                   testing::square_scene(std::move(objects), 2000.0), RunOptions{});
    EXPECT_FALSE(simulation->start());
    return simulation;
}

TEST(Brains, HostWithThePowersOfAProgramMovesRobotsIdentically) {
    testing::use_program([] {},
                         [] {
                             pogobot_motor_set(motorR, 700);
                             pogobot_motor_set(motorL, 900);
                         });
    auto const programmed = simulation_of(testing::test_program(), {testing::robots(30, driven_by(ProgramSpec{}))});
    auto const hosted = simulation_of({}, {testing::robots(30, driven_by(HostSpec{}))});
    HostBrain* const brain = hosted->host_brain("robots");
    ASSERT_NE(brain, nullptr);
    std::ranges::fill(brain->inputs().motors, std::array<std::int32_t, kMotorCount>{700, 900, 0});
    EXPECT_FALSE(testing::run_for(*programmed, 5.0));
    EXPECT_FALSE(testing::run_for(*hosted, 5.0));
    EXPECT_EQ(hosted->world().bodies, programmed->world().bodies);
    EXPECT_EQ(hosted->world().devices.clock_us, programmed->world().devices.clock_us);
    EXPECT_EQ(hosted->world().devices.ticks, programmed->world().devices.ticks);
    EXPECT_EQ(hosted->world().robots.stream, programmed->world().robots.stream);
}

TEST(Brains, ProgramAndHostExchangeMessages) {
    testing::use_program([] {},
                         [] {
                             std::uint8_t text = 42;
                             pogobot_infrared_sendLongMessage_omniGen(&text, 1);
                             while (pogobot_infrared_message_available() != 0) {
                                 message_t message;
                                 pogobot_infrared_recover_next_message(&message);
                                 mydata->number[0] = message.payload[0];
                             }
                         });
    ObjectSpec host = testing::article_robot();
    host.robot->brain = HostSpec{};
    auto const simulation = simulation_of(
        testing::test_program(), {testing::robot_at({1000, 1000}), testing::robot_at({1070, 1000}, host, "hosted")});
    HostBrain* const brain = simulation->host_brain("hosted");
    ASSERT_NE(brain, nullptr);
    brain->inputs().send_bytes[0][0] = std::byte{17};
    brain->inputs().send_length[0] = 1;
    EXPECT_FALSE(testing::run_for(*simulation, 0.1));
    TestData data;
    std::memcpy(&data, simulation->controllers().controller_of(0).user_data, sizeof(data));
    EXPECT_EQ(data.number[0], 17);
    ASSERT_FALSE(brain->received().empty());
    EXPECT_EQ(brain->received_bytes()[0], std::byte{42});
    EXPECT_EQ(brain->received()[0].sender, simulation->world().robots.id[0]);
}

TEST(Brains, RobotOfAScriptCoversSpeedTimesTime) {
    ScriptSpec const script{
        .entries = {{.time_s = 0.0, .motors = {1023, 1023, {}}}, {.time_s = 4.0, .motors = {0, 0, 0}}}};
    ObjectSpec spec = testing::article_robot();
    spec.robot->brain = script;
    auto const simulation = simulation_of({}, {testing::robot_at({300, 1000}, spec)});
    Vec2 const start = simulation->world().bodies.position_mm[0];
    EXPECT_FALSE(testing::run_for(*simulation, 6.0));
    EXPECT_NEAR(length(simulation->world().bodies.position_mm[0] - start), 400.0F, 1.7F);  // a tick's way
}

TEST(Brains, CategoryThatNeedsAProgramIsNamedIfThereIsNone) {
    try {
        simulation_of({}, {testing::robots(2, driven_by(HostSpec{}), "hosted"), testing::robots(1)});
        FAIL();
    } catch (ConfigError const& error) {
        EXPECT_NE(std::string(error.what()).find("category 'robots' needs a program"), std::string::npos);
    }
}

TEST(Brains, WhatAHostWritesIsInTheHash) {
    auto const one = simulation_of({}, {testing::robots(2, driven_by(HostSpec{}))});
    auto const other = simulation_of({}, {testing::robots(2, driven_by(HostSpec{}))});
    EXPECT_EQ(one->hash(), other->hash());
    one->host_brain("robots")->inputs().motors[0] = {1, 1, 1};
    EXPECT_NE(one->hash(), other->hash());
    EXPECT_EQ(one->host_brain("absent"), nullptr);
}

}  // namespace
}  // namespace pogosim
