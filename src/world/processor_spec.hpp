// The processor of a robot, and how long the work of its library takes it. See docs/firmware.md.
#pragma once

#include <cstdint>
#include <string>

#include "riscv/cycle_costs.hpp"

namespace pogosim {

/// How long functions of the robot's library take, us, where time counts (cpu_time: counted). All are estimates from
/// what the chips need, and have not been measured on a robot.
struct CallTimes {
    float call_us = 2.0F;           // any function that is not named here
    float led_us = 5.0F;            // setting an LED
    float motor_us = 5.0F;          // setting a power or a direction
    float light_sensor_us = 20.0F;  // a reading of the analogue-to-digital converter; also of the battery
    float imu_us = 150.0F;          // a reading of acceleration and angular velocity, or of the temperature
    float magnetometer_us = 100.0F;
    float message_us = 50.0F;       // sending a message, besides its bytes
    float message_byte_us = 10.0F;  // each byte on the wire, header and checksum included: 10 bits at 1 Mbit/s
    float receive_us = 20.0F;       // taking a message out of the queue
    float print_byte_us = 87.0F;    // each character: 10 bits at 115 200 bit/s
    float flash_read_us = 300.0F;   // a page of 256 bytes
    float flash_write_us = 1000.0F;
    float flash_erase_us = 3.5e6F;  // the whole user section: 23 blocks of 64 KiB, 0.15 s each

    friend bool operator==(CallTimes const&, CallTimes const&) = default;
};

struct ProcessorSpec {
    std::int64_t clock_hz = 21'000'000;
    std::int64_t memory_bytes = 131'072;  // for program, variables, stack and what it allocates
    CycleCosts cycles{};                  // of instructions
    double cycle_factor = 1.0;            // by which all cycles are multiplied, to fit a measurement on a robot
    CallTimes calls{};

    /// Time of so many cycles, us.
    double us_of(double cycle_count) const {
        constexpr double us_per_s = 1e6;
        return cycle_count * cycle_factor * us_per_s / static_cast<double>(clock_hz);
    }

    friend bool operator==(ProcessorSpec const&, ProcessorSpec const&) = default;
};

/// What a call of a function takes on the robot's processor, on average, with all that it calls.
struct FunctionCost {
    std::string function;
    double cycles = 0.0;      // of its code, before ProcessorSpec::cycle_factor
    double library_us = 0.0;  // in functions of the robot's library

    friend bool operator==(FunctionCost const&, FunctionCost const&) = default;
};

/// Whether the code of a robot takes time of the robot's clock.
enum class CpuTime : std::uint8_t { off, counted };

}  // namespace pogosim
