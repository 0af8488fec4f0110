// Robots whose batteries empty while their programs run.
#include "device/battery.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/lone_robot.hpp"

namespace pogosim {
namespace {

using testing::full_ahead;
using testing::run_alone;

constexpr double kHourS = 3600.0;

std::vector<int16_t> voltages_mv;

/// Enough for two seconds with both motors at full power.
ObjectSpec robot_for_two_seconds() {
    ObjectSpec spec = testing::article_robot();
    spec.robot->battery = {.capacity_mah = 500.0 / kHourS, .idle_ma = 50.0, .motor_ma = 100.0, .led_ma = 0.0};
    return spec;
}

TEST(Battery, RobotStopsWhenItsBatteryIsEmpty) {
    voltages_mv.clear();
    auto const simulation = run_alone(
        robot_for_two_seconds(), full_ahead, [] { voltages_mv.push_back(pogobot_battery_voltage_read()); }, 5.0);
    // It drives for 2 s at 100 mm/s.
    EXPECT_NEAR(simulation->world().bodies.position_mm[0].x, 2500.0F + 200.0F, 2.0F);
    EXPECT_FALSE(is_alive(simulation->world(), 0));
    EXPECT_NEAR(static_cast<double>(voltages_mv.size()), 2.0 / 0.016, 2.0);
    EXPECT_NEAR(voltages_mv.front(), 4200, 1);
    EXPECT_LT(voltages_mv.back(), 3100);
    EXPECT_TRUE(std::ranges::is_sorted(voltages_mv, std::greater<>()));
}

TEST(Battery, RobotThatStandsLastsLonger) {
    auto const simulation = run_alone(
        robot_for_two_seconds(), [] {}, [] {}, 9.9);
    EXPECT_TRUE(is_alive(simulation->world(), 0));
    EXPECT_FALSE(is_alive(run_alone(
                              robot_for_two_seconds(), [] {}, [] {}, 10.1)
                              ->world(),
                          0));
}

TEST(Battery, ObjectWithoutWheelsPaysForNoMotors) {
    ObjectSpec spec = robot_for_two_seconds();
    spec.robot->model.drives.clear();
    EXPECT_TRUE(is_alive(run_alone(
                             spec, full_ahead, [] {}, 9.9)
                             ->world(),
                         0));
}

TEST(Battery, ThatIsPutIntoARobotAgainIsFull) {
    testing::use_program(full_ahead, [] { voltages_mv.push_back(pogobot_battery_voltage_read()); });
    Simulation simulation(testing::test_program(),
                          testing::square_scene({testing::robot_at({2500, 2500}, robot_for_two_seconds())}, 5000.0),
                          {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 3.0));
    ASSERT_FALSE(is_alive(simulation.world(), 0));
    simulation.set_alive(0, true);
    voltages_mv.clear();
    ASSERT_FALSE(testing::run_for(simulation, 1.0));
    EXPECT_TRUE(is_alive(simulation.world(), 0));
    EXPECT_NEAR(voltages_mv.front(), 4200, 20);
    ASSERT_FALSE(testing::run_for(simulation, 1.5));
    EXPECT_FALSE(is_alive(simulation.world(), 0));
}

TEST(Battery, IsFullForEverUnlessTheConfigurationSaysOtherwise) {
    voltages_mv.clear();
    run_alone(
        testing::article_robot(), full_ahead, [] { voltages_mv.push_back(pogobot_battery_voltage_read()); }, 1.0);
    ASSERT_FALSE(voltages_mv.empty());
    EXPECT_TRUE(std::ranges::all_of(voltages_mv, [](int16_t mv) { return mv == 4200; }));
}

}  // namespace
}  // namespace pogosim
