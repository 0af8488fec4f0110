// LEDs, motors and sensors of a robot, for a firmware.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "device/arguments.hpp"
#include "device/battery.hpp"
#include "device/chips.hpp"
#include "device/leds.hpp"
#include "device/magnetometer.hpp"
#include "device/motors.hpp"
#include "device/sensors.hpp"
#include "firmware/firmware_call.hpp"

namespace pogosim {

namespace {

// ---- LEDs

void set_colour(FirmwareCall const& call, std::uint8_t led) {
    if (is_led(call.model(), led, call)) {
        set_led(call.world, call.robot, led, {call.byte(0), call.byte(1), call.byte(2)});
    }
}

CallOutcome set_head_colour(FirmwareCall& call) {
    set_colour(call, 0);
    return CallOutcome::returns;
}

CallOutcome set_led_colour(FirmwareCall& call) {
    set_colour(call, call.byte(3));
    return CallOutcome::returns;
}

// ---- Motors

Motors& motors_of(FirmwareCall const& call) {
    return call.world.devices.motors[call.robot];
}

CallOutcome set_power(FirmwareCall& call) {
    if (is_motor(call.number(0), call)) {
        check_power(call.half(1), call);
        check_motor_is_there(call.world.spec_of(call.robot).model, call.number(0), call.half(1), call);
        set_motor_power(call.world, call.robot, call.number(0), call.half(1));
    }
    return CallOutcome::returns;
}

CallOutcome set_direction(FirmwareCall& call) {
    if (is_motor(call.number(0), call)) {
        check_direction(call.byte(1), call);
        set_motor_direction(call.world, call.robot, call.number(0), call.byte(1));
    }
    return CallOutcome::returns;
}

CallOutcome get_directions(FirmwareCall& call) {
    call.give(motor_directions(call.world, call.robot));
    return CallOutcome::returns;
}

template <auto Values>
CallOutcome get_stored(FirmwareCall& call) {
    call.write(call.argument(0), std::as_bytes(std::span(motors_of(call).*Values)));
    call.give(0);
    return CallOutcome::returns;
}

template <auto Values>
CallOutcome set_stored(FirmwareCall& call) {
    auto& stored = motors_of(call).*Values;
    call.read(call.argument(0), std::as_writable_bytes(std::span(stored)));
    check_stored(stored, call);
    call.give(0);
    return CallOutcome::returns;
}

// ---- Sensors

bool has_body(FirmwareCall const& call) {
    return call.world.robots.body[call.robot] != kNone;
}

CallOutcome get_light(FirmwareCall& call) {
    std::uint8_t const sensor = call.byte(0);
    call.give_signed(-1);
    if (is_light_sensor(call.model(), sensor, call) && has_body(call)) {
        if (call.world.lamps.empty()) {
            call.warn_once(kNoLamps, fmt::format("{}(): {}", call.function, kNoLamps));
        }
        call.give_signed(read_photosensor(call.world, call.robot, sensor));
    }
    return CallOutcome::returns;
}

void write_floats(FirmwareCall const& call, std::uint32_t address, std::array<float, 3> const& values) {
    for (std::uint32_t i = 0; i < values.size(); ++i) {
        call.write_word(address + 4 * i, std::bit_cast<std::uint32_t>(values[i]));
    }
}

CallOutcome get_motion(FirmwareCall& call) {
    ImuReading const reading = has_body(call) ? read_imu(call.world, call.robot) : ImuReading{};
    write_floats(call, call.argument(0), reading.acceleration);
    write_floats(call, call.argument(1), reading.angular_velocity);
    return CallOutcome::returns;
}

CallOutcome get_temperature(FirmwareCall& call) {
    call.give_float(thermometer_c(call.world.temperature_c, call.world.spec_of(call.robot).sensors.model));
    return CallOutcome::returns;
}

CallOutcome get_voltage(FirmwareCall& call) {
    call.give_signed(battery_voltage_mv(call.world, call.robot));
    return CallOutcome::returns;
}

// ---- Magnetometer

CallOutcome has_found_magnetometer(FirmwareCall& call) {
    call.give(has_magnetometer(call.world, call.robot) ? 1 : 0);
    return CallOutcome::returns;
}

CallOutcome has_not_found_magnetometer(FirmwareCall& call) {
    call.give(has_magnetometer(call.world, call.robot) ? 0 : 1);
    return CallOutcome::returns;
}

CallOutcome take_field(FirmwareCall& call) {
    auto const counts = read_magnetometer(call.world, call.robot);
    if (!counts) {
        throw RefusedCall(refused_pose_text(magnetometer_pose(call.world, call.robot)).data());
    }
    for (std::size_t axis = 0; axis < counts->size(); ++axis) {
        std::array<std::byte, 2> bytes{};
        write_little_endian<2>(bytes.data(), static_cast<std::uint16_t>((*counts)[axis]));
        call.write(call.argument(axis), bytes);
    }
    call.give(0);
    return CallOutcome::returns;
}

CallOutcome get_field(FirmwareCall& call) {
    std::optional<bool> finds_data = std::exchange(call.self.finds_data, std::nullopt);
    if (!has_magnetometer(call.world, call.robot)) {
        finds_data = false;
    } else if (!finds_data && call.world.magnetometer.timing == MagnetometerTiming::at_once) {
        finds_data = true;
    } else if (!finds_data) {
        MagnetometerPoll const poll =
            poll_magnetometer(call.clock_us(), call.world.devices.magnetometer[call.robot].taken, call.half(3));
        finds_data = poll.finds_data;
        if (poll.wait_us > 0) {
            call.self.finds_data = finds_data;
            call.clock_us() += poll.wait_us;
            call.self.calls = 0;
            return CallOutcome::repeats;
        }
    }
    if (*finds_data) {
        return take_field(call);
    }
    call.give(1);
    return CallOutcome::returns;
}

}  // namespace

std::span<LibraryFunction const> device_functions() {
    static std::array const functions{
        LibraryFunction{"pogobot_led_setColor", set_head_colour, &CallTimes::led_us},
        LibraryFunction{"pogobot_led_setColors", set_led_colour, &CallTimes::led_us},
        LibraryFunction{"pogobot_motor_power_set", set_power, &CallTimes::motor_us},
        LibraryFunction{"pogobot_motor_set", set_power, &CallTimes::motor_us},
        LibraryFunction{"pogobot_motor_dir_set", set_direction, &CallTimes::motor_us},
        LibraryFunction{"pogobot_motor_dir_current_status", get_directions},
        LibraryFunction{"pogobot_motor_dir_mem_get", get_stored<&Motors::stored_direction>, &CallTimes::flash_read_us},
        LibraryFunction{"pogobot_motor_dir_mem_set", set_stored<&Motors::stored_direction>, &CallTimes::flash_write_us},
        LibraryFunction{"pogobot_motor_power_mem_get", get_stored<&Motors::stored_power>, &CallTimes::flash_read_us},
        LibraryFunction{"pogobot_motor_power_mem_set", set_stored<&Motors::stored_power>, &CallTimes::flash_write_us},
        LibraryFunction{"pogobot_photosensors_read", get_light, &CallTimes::light_sensor_us},
        LibraryFunction{"pogobot_battery_voltage_read", get_voltage, &CallTimes::light_sensor_us},
        LibraryFunction{"pogobot_imu_read", get_motion, &CallTimes::imu_us},
        LibraryFunction{"pogobot_imu_readTemp", get_temperature, &CallTimes::imu_us},
        LibraryFunction{"magn_init", has_found_magnetometer},
        LibraryFunction{"magn_check", has_not_found_magnetometer},
        LibraryFunction{"magn_begin", do_nothing},
        LibraryFunction{"magn_end", do_nothing},
        LibraryFunction{"magn_read_XYZ", get_field, &CallTimes::magnetometer_us},
    };
    return functions;
}

}  // namespace pogosim
