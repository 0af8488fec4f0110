// Which values functions of Pogolib take, and what becomes of others: the same for programs in C and for firmware.
//
// Those that answer say whether a value can be used. `note(wrong, value)` is called for one that cannot be as it is.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "device/infrared.hpp"
#include "device/motors.hpp"
#include "interface/pogobase_inside.hpp"
#include "world/mailbox.hpp"
#include "world/robot_model.hpp"
#include "world/world.hpp"

namespace pogosim {

/// All are literals.
struct Slip {
    std::string_view function;  // "pogobot_motor_set"; empty: a variable of the main loop
    std::string_view argument;  // "value", or the variable
    std::string_view expected;  // "0 to 1023 (motorFull)"
    std::string_view outcome;   // "1023 is used"
};

/// The same without the function.
struct WrongArgument {
    std::string_view name;
    std::string_view expected;
    std::string_view outcome;
};

template <class Value>
std::string slip_text(Slip const& slip, Value const& value) {
    return fmt::format("{}{}{} is {}, expected {}; {}", slip.function,
                       slip.function.empty() ? "" : "(): ", slip.argument, value, slip.expected, slip.outcome);
}

/// What is expected of the number of a part of which a robot has so many. Literals.
constexpr std::string_view one_of_parts(std::size_t count, std::string_view some, std::string_view none) {
    return count > 0 ? some : none;
}

/// Values of the interface come first, then those that a robot's model lacks.
template <class Note>
bool is_led(RobotModel const& model, std::uint8_t id, Note const& note) {
    if (id >= kLedCount) [[unlikely]] {
        note(WrongArgument{"id", "0 (head) to 4 (left)", "nothing is set"}, id);
    } else if (id >= model.leds.size()) [[unlikely]] {
        note(WrongArgument{"id",
                           one_of_parts(model.leds.size(), "one of the leds of this robot's model, from 0",
                                        "none, since this robot's model has no LEDs"),
                           "nothing is set"},
             id);
    }
    return id < model.leds.size();
}

template <class Note>
bool is_light_sensor(RobotModel const& model, std::uint8_t sensor, Note const& note) {
    constexpr std::string_view outcome = "-1 is returned";
    if (sensor >= kPhotosensorCount) [[unlikely]] {
        note(WrongArgument{"sensor_number", "p_B (0, back), p_FL (1, front left) or p_FR (2, front right)", outcome},
             sensor);
    } else if (sensor >= model.light_sensors.size()) [[unlikely]] {
        note(WrongArgument{"sensor_number",
                           one_of_parts(model.light_sensors.size(),
                                        "one of the light_sensors of this robot's model, from 0",
                                        "none, since this robot's model has no light sensors"),
                           outcome},
             sensor);
    }
    return sensor < model.light_sensors.size();
}

/// `outcome`: "nothing is read".
template <class Note>
bool is_flash_page(RobotModel const& model, std::uint16_t page, std::string_view outcome, Note const& note) {
    if (page >= kFlashPageCount) [[unlikely]] {
        note(WrongArgument{"page", "0 to 5887 (POGOBOT_USER_FLASH_PAGE_COUNT - 1)", outcome}, page);
    } else if (page >= model.flash_pages) [[unlikely]] {
        note(WrongArgument{"page",
                           one_of_parts(model.flash_pages, "one of the flash_pages of this robot's model, from 0",
                                        "none, since this robot's model has no pages of flash memory"),
                           outcome},
             page);
    }
    return page < model.flash_pages;
}

template <class Note>
bool is_motor(int motor, Note const& note) {
    bool const is_known = motor >= 0 && motor < static_cast<int>(kMotorCount);
    if (!is_known) [[unlikely]] {
        note(WrongArgument{"motor", "motorR (0), motorL (1) or motorB (2)", "nothing is set"}, motor);
    }
    return is_known;
}

/// A motor that the robot lacks is inert, as a connector without a motor is.
template <class Note>
void check_motor_is_there(RobotModel const& model, int motor, std::uint16_t power, Note const& note) {
    if (power > 0 && !model.has_motor(motor)) [[unlikely]] {
        note(WrongArgument{"motor",
                           one_of_parts(model.drives.size(), "one of the motors of this robot's model",
                                        "none, since this robot's model has no motors"),
                           "it moves nothing"},
             motor);
    }
}

/// A power that is negative as a 16-bit number was meant as a reversed direction.
template <class Note>
void check_power(std::uint16_t power, Note const& note) {
    constexpr std::string_view expected = "0 to 1023 (motorFull)";
    if (power > std::numeric_limits<std::int16_t>::max()) [[unlikely]] {
        note(WrongArgument{"value", expected,
                           "powers are unsigned, so this one drives the motor at full power; to reverse it, use "
                           "pogobot_motor_dir_set and a positive power"},
             static_cast<int>(static_cast<std::int16_t>(power)));
    } else if (power > kFullMotorPower) [[unlikely]] {
        note(WrongArgument{"value", expected, "1023 is used"}, power);
    }
}

template <class Note>
void check_direction(std::uint8_t direction, Note const& note) {
    if (direction > 1) [[unlikely]] {
        note(WrongArgument{"value", "0 or 1", "1 is used"}, direction);
    }
}

template <class T, class Note>
void check_each(std::string_view name, std::span<T const> values, T most, std::string_view expected, Note const& note) {
    auto const wrong = std::ranges::find_if(values, [most](T value) { return value > most; });
    if (wrong != values.end()) [[unlikely]] {
        note(WrongArgument{name, expected, "it is stored as it is"}, *wrong);
    }
}

/// Directions for the persistent memory of motors.
template <class Note>
void check_stored(std::span<std::uint8_t const> directions, Note const& note) {
    check_each<std::uint8_t>("p_directions", directions, 1, "0 or 1 for each motor", note);
}

/// Powers for it.
template <class Note>
void check_stored(std::span<std::uint16_t const> powers, Note const& note) {
    check_each<std::uint16_t>("p_powers", powers, kFullMotorPower, "0 to 1023 (motorFull) for each motor", note);
}

/// `name`: "milliseconds".
template <class Note>
void check_duration(std::string_view name, int duration, Note const& note) {
    if (duration < 0) [[unlikely]] {
        note(WrongArgument{name, "at least 0", "it takes no time"}, duration);
    }
}

inline constexpr std::string_view kNothingSent = "nothing is sent, and the function returns 1";

template <class Note>
bool is_payload_size(std::uint16_t bytes, Note const& note) {
    static_assert(kMostPayloadBytes == 382);
    bool const fits = bytes <= kMostPayloadBytes;
    if (!fits) [[unlikely]] {
        note(WrongArgument{"the length of the message", "0 to 382 bytes (MAX_PAYLOAD_SIZE_BYTES)", kNothingSent},
             bytes);
    }
    return fits;
}

/// The emitters of a robot with these faces (bits) for a direction.
template <class Note>
std::uint8_t emitters_of_direction(std::uint8_t faces, int direction, Note const& note) {
    if (direction < 0 || direction > static_cast<int>(ir_all)) [[unlikely]] {
        note(WrongArgument{"dir", "ir_front (0) to ir_left (3), or ir_all (4)", "the message goes in all directions"},
             direction);
    }
    if (direction < 0 || direction >= static_cast<int>(kMostFaces)) {
        return faces;
    }
    auto const emitters = static_cast<std::uint8_t>(faces & 1U << direction);
    if (emitters == 0) [[unlikely]] {
        note(WrongArgument{"dir", "one of the faces of this robot's model, from 0", "nothing is sent"}, direction);
    }
    return emitters;
}

/// The emitters with a power in the list of a raw message.
template <class Note>
void check_emitters(std::uint8_t emitters, std::uint8_t power_list, Note const& note) {
    if (emitters == 0) [[unlikely]] {
        note(WrongArgument{"_emitting_power_list", "a power that is not 0 for at least one emitter",
                           "nothing is sent, as on a real robot"},
             power_list);
    }
}

template <class Note>
void check_emitter_power(std::uint8_t power, Note const& note) {
    if (power > kMostIrPower) [[unlikely]] {
        note(WrongArgument{"power", "0 to 3", "3 is used"}, power);
    }
}

template <class Note>
void check_receiver(std::uint8_t index, Note const& note) {
    if (index >= IR_RX_COUNT) [[unlikely]] {
        note(WrongArgument{"ir_index", "0 (front) to 3 (left)", "the counters are set to 0"}, index);
    }
}

}  // namespace pogosim
