// What a robot has lost, and what it has kept, when the remote control has restarted it.
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "robot/context.hpp"
#include "robot/controllers.hpp"
#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

constexpr std::uint8_t kPower = 3;
std::array<std::uint8_t, kMotorCount> stored{1, 0, 1};
int starts = 0;

/// As one that hears DEADBEEF in its first step, with lit LEDs, another power, and motors that turn the other way.
void step() {
    if (starts > 1) {
        return;
    }
    pogobot_led_setColor(1, 2, 3);
    pogobot_infrared_set_power(kPower);
    pogobot_motor_dir_mem_set(stored.data());
    pogobot_motor_dir_set(motorL, 0);
    pogobot_motor_dir_set(motorR, 1);
    context.services->controllers->ask_for_restart();
}

class Restarts : public ::testing::Test {
protected:
    Restarts() {
        starts = 0;
        testing::use_program([] { ++starts; }, step);
        simulation_ = std::make_unique<Simulation>(
            testing::test_program(), testing::square_scene({testing::robot_at({500, 500})}), RunOptions{});
        EXPECT_FALSE(simulation_->start());
    }

    Devices const& devices() const { return simulation_->world().devices; }
    Controller const& robot() const { return simulation_->controllers().controller_of(0); }

    void step_until_it_is_due() {
        for (int i = 0; i < 10 && !robot().is_restart_due; ++i) {
            ASSERT_FALSE(simulation_->step());
        }
        ASSERT_TRUE(robot().is_restart_due);
    }

    std::unique_ptr<Simulation> simulation_;
};

TEST_F(Restarts, LedsAreDarkPowerIsTheDefaultAndMotorsHaveTheirStoredDirections) {
    step_until_it_is_due();
    World const& world = simulation_->world();
    ASSERT_NE(world.robots.led[0], Leds{});
    ASSERT_EQ(devices().ir_power[0], kPower);
    ASSERT_NE(devices().motors[0].direction, stored);
    ASSERT_FALSE(testing::run_for(*simulation_, 0.1));
    EXPECT_EQ(starts, 2);
    EXPECT_EQ(world.robots.led[0], Leds{});
    EXPECT_EQ(devices().ir_power[0], kUsualIrPower);
    EXPECT_EQ(devices().motors[0].direction, stored);
    EXPECT_EQ(devices().motors[0].stored_direction, stored);
}

TEST_F(Restarts, RobotThatIsSwitchedOffRestartsWhenItIsSwitchedOn) {
    step_until_it_is_due();
    simulation_->set_alive(0, false);
    ASSERT_FALSE(testing::run_for(*simulation_, 0.2));
    EXPECT_EQ(starts, 1);
    simulation_->set_alive(0, true);
    ASSERT_FALSE(testing::run_for(*simulation_, 0.1));
    EXPECT_EQ(starts, 2);
}

}  // namespace
}  // namespace pogosim
