#include "device/battery.hpp"

#include <algorithm>

#include "device/chips.hpp"

namespace pogosim {

namespace {

constexpr double kSecondsPerHour = 3600.0;
constexpr double kFullBrightness = 3.0 * 255.0;  // of the three colours of an LED

struct CurvePoint {
    double charge;
    double voltage_mv;
};
constexpr std::array kCurve{
    CurvePoint{0.00, 3000.0}, CurvePoint{0.05, 3450.0}, CurvePoint{0.10, 3610.0}, CurvePoint{0.20, 3700.0},
    CurvePoint{0.40, 3770.0}, CurvePoint{0.60, 3840.0}, CurvePoint{0.80, 3980.0}, CurvePoint{1.00, kFullBatteryMv},
};

}  // namespace

double capacity_mas(BatterySpec const& spec) {
    return spec.capacity_mah * kSecondsPerHour;
}

Battery initial_battery(BatterySpec const& spec) {
    constexpr double percent = 100.0;
    return {.used_mas = capacity_mas(spec) * (1.0 - spec.initial_percent / percent)};
}

double current_ma(BatterySpec const& spec, double motor_share, Leds const& leds) {
    double brightness = 0.0;
    for (Rgb const led : leds) {
        brightness += led.r + led.g + led.b;
    }
    return spec.idle_ma + spec.motor_ma * motor_share + spec.led_ma * brightness / kFullBrightness;
}

void drain(Battery& battery, BatterySpec const& spec, double drawn_ma, double duration_s) {
    battery.used_mas = std::min(battery.used_mas + drawn_ma * duration_s, capacity_mas(spec));
}

double charge_left(Battery const& battery, BatterySpec const& spec) {
    return 1.0 - battery.used_mas / capacity_mas(spec);
}

double cell_voltage_mv(double charge) {
    auto const upper = std::ranges::find_if(kCurve, [charge](CurvePoint const& at) { return at.charge >= charge; });
    if (upper == kCurve.begin() || upper == kCurve.end()) {
        return upper == kCurve.end() ? kFullBatteryMv : upper->voltage_mv;
    }
    CurvePoint const& lower = *(upper - 1);
    double const share = (charge - lower.charge) / (upper->charge - lower.charge);
    return lower.voltage_mv + share * (upper->voltage_mv - lower.voltage_mv);
}

std::int16_t battery_voltage_mv(World const& world, std::uint32_t robot) {
    RobotSpec const& spec = world.spec_of(robot);
    double const voltage_mv =
        spec.battery ? cell_voltage_mv(charge_left(world.devices.battery[robot], *spec.battery)) : kFullBatteryMv;
    return voltmeter_mv(voltage_mv, spec.sensors.model);
}

}  // namespace pogosim
