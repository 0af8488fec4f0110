// Batteries that empty.
#include "device/battery.hpp"

#include <gtest/gtest.h>

namespace pogosim {
namespace {

constexpr double kHourS = 3600.0;

TEST(Battery, IsEmptyAfterItsCapacityDividedByTheCurrent) {
    BatterySpec const spec{.capacity_mah = 10.0, .idle_ma = 40.0, .motor_ma = 0.0, .led_ma = 0.0};
    Battery battery = initial_battery(spec);
    double seconds = 0.0;
    while (charge_left(battery, spec) > 0.0) {
        drain(battery, spec, current_ma(spec, 0.0, {}), 0.5);
        seconds += 0.5;
    }
    EXPECT_NEAR(seconds, 10.0 / 40.0 * kHourS, 0.5);
    drain(battery, spec, 1000.0, 1.0);
    EXPECT_EQ(charge_left(battery, spec), 0.0);  // never less than empty
}

TEST(Battery, CurrentIsThatOfProcessorMotorsAndLeds) {
    BatterySpec const spec{.idle_ma = 50.0, .motor_ma = 100.0, .led_ma = 30.0};
    EXPECT_DOUBLE_EQ(current_ma(spec, 0.0, {}), 50.0);
    EXPECT_DOUBLE_EQ(current_ma(spec, 1.5, {}), 200.0);
    Leds leds{};
    leds[0] = {255, 255, 255};
    EXPECT_DOUBLE_EQ(current_ma(spec, 0.0, leds), 80.0);
    leds[4] = {255, 0, 0};
    EXPECT_DOUBLE_EQ(current_ma(spec, 0.0, leds), 90.0);
}

TEST(Battery, VoltageFallsFrom4200To3000Millivolts) {
    EXPECT_DOUBLE_EQ(cell_voltage_mv(1.0), kFullBatteryMv);
    EXPECT_DOUBLE_EQ(cell_voltage_mv(0.0), 3000.0);
    EXPECT_DOUBLE_EQ(cell_voltage_mv(0.5), 3805.0);  // between 3770 at 40 % and 3840 at 60 %
    double above = cell_voltage_mv(1.0);
    for (int percent = 99; percent >= 0; --percent) {
        double const now = cell_voltage_mv(percent / 100.0);
        EXPECT_LT(now, above);
        above = now;
    }
}

TEST(Battery, InitialChargeIsAShareOfTheCapacity) {
    BatterySpec const spec{.capacity_mah = 100.0, .initial_percent = 25.0};
    EXPECT_DOUBLE_EQ(charge_left(initial_battery(spec), spec), 0.25);
}

}  // namespace
}  // namespace pogosim
