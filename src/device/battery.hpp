// The battery of a robot: a lithium cell that its processor, motors and LEDs empty. Plain functions; the voltage is
// that of the cell without load.
#pragma once

#include <array>
#include <cstdint>

#include "world/specs.hpp"
#include "world/world.hpp"

namespace pogosim {

inline constexpr double kFullBatteryMv = 4200.0;

double capacity_mas(BatterySpec const& spec);

/// As it is at the start of a run.
Battery initial_battery(BatterySpec const& spec);

/// `motor_share`: sum over the motors of power divided by full power.
double current_ma(BatterySpec const& spec, double motor_share, Leds const& leds);

/// Takes charge out of it, down to nothing.
void drain(Battery& battery, BatterySpec const& spec, double drawn_ma, double duration_s);

/// 1: full, 0: empty.
double charge_left(Battery const& battery, BatterySpec const& spec);

/// Voltage of the cell with so much of its charge left, mV: 4200 when full, 3000 when empty, and mostly flat in
/// between, by a table of typical values of lithium-polymer cells at rest.
double cell_voltage_mv(double charge);

/// A robot's battery voltage as its program reads it, mV; a category without `battery` has a full one.
std::int16_t battery_voltage_mv(World const& world, std::uint32_t robot);

}  // namespace pogosim
