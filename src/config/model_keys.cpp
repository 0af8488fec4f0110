#include "config/object_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "config/read_list.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kFaces = "a list of maps, such as [{angle_deg: 0}, {angle_deg: 180}]";
constexpr std::string_view kLeds = "a list of maps, such as [{place: centre}, {angle_deg: 0}]";
constexpr std::string_view kSensors = "a list of maps, such as [{angle_deg: 180}]";
constexpr std::string_view kMotor = "a map, such as {linear_mm_s: 50, angular_rad_s: 2}";
constexpr std::string_view kMotors = "a map of motors, such as {left: {linear_mm_s: 50, angular_rad_s: 2}}, or {}";
constexpr std::string_view kProcessor = "a map of keys, such as {clock_hz: 21000000, memory_bytes: 131072}";
constexpr std::string_view kCycles = "a map of keys, such as {load: 3, multiply: 33}";
constexpr std::string_view kCallTimes = "a map of keys, such as {imu_us: 150, message_byte_us: 10}";
constexpr std::string_view kPlace = "rim, centre, or [x, y] from the centre (mm)";

constexpr Range kAperture = above(0).up_to(180);

std::span<Key<RobotSpec> const> part_keys() {
    using K = Key<RobotSpec>;
    static std::array const keys{
        K{"faces", Elsewhere{kFaces}, any(), "",
          "Infrared faces, one to four, from number 0; see their table. Default: those of the type."},
        K{"leds", Elsewhere{kLeds}, any(), "",
          "LEDs, up to five, the head first; see their table. Default: head, front, right, back, left."},
        K{"light_sensors", Elsewhere{kSensors}, any(), "",
          "Light sensors, up to three; see their table. Default: on the rim at 180, 320 and 40 degrees."},
        K{"motors", Elsewhere{kMotors}, any(), "",
          "Motors that move the robot; see their table. Default: those of the type."},
        K{"processor", Elsewhere{kProcessor}, any(), "", "Processor of the robot; see its table."},
    };
    return keys;
}

struct WrittenFlash {
    std::optional<std::uint32_t> pages;
};

std::span<Key<WrittenFlash> const> flash_keys() {
    static std::array const keys{
        Key<WrittenFlash>{"flash_pages", &WrittenFlash::pages, between(0, 5888).whole(), "pages of 256 bytes",
                          "Pages of flash memory for programs. Default: 5888."},
    };
    return keys;
}

/// A part as it is written.
struct WrittenPart {
    double angle_deg = 0.0;
    float emission_deg = 180.0F;
    float reception_deg = 180.0F;
};

std::span<Key<WrittenPart> const> place_keys() {
    using K = Key<WrittenPart>;
    static std::array const keys{
        K{"angle_deg", &WrittenPart::angle_deg, kDegrees, "degrees",
          "Direction of the part from the robot's heading, clockwise on the screen: 90 is to the right."},
        K{"place", Elsewhere{kPlace}, any(), "",
          "rim: where the bounding circle has that direction. Default: rim; [x, y]: x along the heading, y to the "
          "right."},
    };
    return keys;
}

std::span<Key<WrittenPart> const> aperture_keys() {
    using K = Key<WrittenPart>;
    static std::array const keys{
        K{"emission_deg", &WrittenPart::emission_deg, kAperture, "degrees",
          "Aperture of what it sends: the whole angle of the cone around its direction; 180: the half plane in front."},
        K{"reception_deg", &WrittenPart::reception_deg, kAperture, "degrees", "Aperture of what it hears."},
    };
    return keys;
}

/// A motor as it is written: what it gives at full power forwards.
struct WrittenMotor {
    float linear_mm_s = 0.0F;
    float angular_rad_s = 0.0F;
    int forward = 0;
};

std::span<Key<WrittenMotor> const> motor_keys() {
    using K = Key<WrittenMotor>;
    static std::array const keys{
        K{"linear_mm_s", &WrittenMotor::linear_mm_s, between(-1e6, 1e6), "mm/s",
          "What the motor adds to the robot's speed along its heading, at full power forwards."},
        K{"angular_rad_s", &WrittenMotor::angular_rad_s, between(-1e4, 1e4).usually_up_to(50), "rad/s",
          "What it adds to the angular velocity, clockwise on the screen."},
        K{"forward", &WrittenMotor::forward, between(0, 1).whole(), "",
          "Direction bit with which it turns forwards (pogobot_motor_dir_set). Default: 0 on the right and the back, 1 "
          "on the left."},
    };
    return keys;
}

std::span<Key<ProcessorSpec> const> processor_keys() {
    using K = Key<ProcessorSpec>;
    static std::array const keys{
        K{"clock_hz", &ProcessorSpec::clock_hz, between(1, 4e9).whole(), "Hz",
          "Clock rate. Code takes no time unless `cpu_time` is counted."},
        K{"memory_bytes", &ProcessorSpec::memory_bytes, between(1024, 4e9).whole(), "bytes",
          "Memory of a firmware for program, variables, stack and what it allocates. For a program in C, warnings say "
          "when it would not be enough."},
        K{"cycle_factor", &ProcessorSpec::cycle_factor, between(1e-3, 1000), "",
          "By which all cycles are multiplied, to fit a measurement on a robot."},
        K{"cycles", Elsewhere{kCycles}, any(), "", "How many cycles instructions take; see its table."},
        K{"call_times", Elsewhere{kCallTimes}, any(), "", "How long functions of the library take; see its table."},
    };
    return keys;
}

std::span<Key<CycleCosts> const> cycle_keys() {
    using K = Key<CycleCosts>;
    constexpr Range most = between(1, 1000).whole();
    constexpr Range most_or_none = between(0, 1000).whole();
    static std::array const keys{
        K{"alu", &CycleCosts::alu, most, "cycles", "Addition, comparison, logic, lui, auipc, fence."},
        K{"shift", &CycleCosts::shift, most, "cycles", "A shift by 0 bits or 1."},
        K{"shift_further_bit", &CycleCosts::shift_further_bit, most_or_none, "cycles", "Each further bit of a shift."},
        K{"load", &CycleCosts::load, most, "cycles", "Reading memory: lb, lh, lw."},
        K{"store", &CycleCosts::store, most, "cycles", "Writing memory: sb, sh, sw."},
        K{"multiply", &CycleCosts::multiply, most, "cycles", "mul, mulh."},
        K{"divide", &CycleCosts::divide, most, "cycles", "div, rem."},
        K{"jump", &CycleCosts::jump, most, "cycles", "jal."},
        K{"jump_register", &CycleCosts::jump_register, most, "cycles", "jalr, as at the end of a function."},
        K{"branch_predicted_taken", &CycleCosts::branch_predicted_taken, most, "cycles",
          "A branch backwards that is taken."},
        K{"branch_predicted_not_taken", &CycleCosts::branch_predicted_not_taken, most, "cycles",
          "A branch forwards that is not taken."},
        K{"branch_mispredicted", &CycleCosts::branch_mispredicted, most, "cycles", "Any other branch."},
        K{"cache_miss", &CycleCosts::cache_miss, most_or_none, "cycles",
          "Fetching a line of 32 bytes of code that is not in the instruction cache of 2 KiB. 0: all code is in it."},
    };
    return keys;
}

std::span<Key<CallTimes> const> call_time_keys() {
    using K = Key<CallTimes>;
    constexpr Range most = between(0, 1e8);
    static std::array const keys{
        K{"call_us", &CallTimes::call_us, most, "us", "Any function that has no key here."},
        K{"led_us", &CallTimes::led_us, most, "us", "Setting an LED."},
        K{"motor_us", &CallTimes::motor_us, most, "us", "Setting a power or a direction of a motor."},
        K{"light_sensor_us", &CallTimes::light_sensor_us, most, "us", "Reading a light sensor or the battery."},
        K{"imu_us", &CallTimes::imu_us, most, "us", "Reading acceleration and angular velocity, or the temperature."},
        K{"magnetometer_us", &CallTimes::magnetometer_us, most, "us", "Reading the magnetometer."},
        K{"message_us", &CallTimes::message_us, most, "us", "Sending a message, besides its bytes."},
        K{"message_byte_us", &CallTimes::message_byte_us, most, "us",
          "Each byte of a message that is sent, header and checksum included."},
        K{"receive_us", &CallTimes::receive_us, most, "us", "Taking a message out of the queue."},
        K{"print_byte_us", &CallTimes::print_byte_us, most, "us", "Each character that is printed."},
        K{"flash_read_us", &CallTimes::flash_read_us, most, "us", "Reading a page of flash memory."},
        K{"flash_write_us", &CallTimes::flash_write_us, most, "us", "Writing a page of flash memory."},
        K{"flash_erase_us", &CallTimes::flash_erase_us, most, "us", "Erasing flash memory."},
    };
    return keys;
}

void read_processor(MapReader& reader, ProcessorSpec& processor) {
    reader.read(processor_keys(), processor);
    reader.read_map("cycles", kCycles, [&](MapReader& map) { map.read(cycle_keys(), processor.cycles); });
    reader.read_map("call_times", kCallTimes, [&](MapReader& map) { map.read(call_time_keys(), processor.calls); });
}

bool is_central(MapReader const& reader) {
    Node const* const node = reader.find("place");
    return node != nullptr && (node->scalar == "centre" || node->scalar == "center");
}

PartPlace place_of_part(MapReader const& reader, Vec2 direction) {
    Node const* const node = reader.find("place");
    if (node == nullptr || node->scalar == "rim") {
        return {.radii = direction};
    }
    if (is_central(reader)) {
        return {};
    }
    if (node->kind != Node::Kind::sequence) {
        fail_expected({*node, reader.path_of("place")}, kPlace);
    }
    PartPlace place;
    read_value({*node, reader.path_of("place")}, Limits{kCoordinate, "mm"}, place.offset_mm);
    return place;
}

Part read_part(MapReader& reader) {
    WrittenPart written;
    reader.read(place_keys(), written);
    Vec2 const direction = is_central(reader) ? Vec2{} : direction_of_deg(written.angle_deg);
    return {.direction = direction, .place = place_of_part(reader, direction)};
}

Face read_face(MapReader& reader) {
    WrittenPart written;
    reader.read(place_keys(), written);
    reader.read(aperture_keys(), written);
    Vec2 const normal = direction_of_deg(written.angle_deg);
    return {.normal = normal,
            .place = place_of_part(reader, normal),
            .emission_deg = written.emission_deg,
            .reception_deg = written.reception_deg};
}

/// A motor of Pogolib, with the direction bit that is forwards on a Pogobot.
struct NamedMotor {
    std::string_view name;
    std::uint8_t id;
    int forward;
};
constexpr std::array kNamedMotors{NamedMotor{"right", 0, 0}, NamedMotor{"left", 1, 1}, NamedMotor{"back", 2, 0}};

/// The motors as shares of what all of them give together.
void set_drives(std::vector<std::pair<std::uint8_t, WrittenMotor>> const& motors, RobotSpec& robot) {
    float linear_mm_s = 0.0F;
    float angular_rad_s = 0.0F;
    for (auto const& [id, motor] : motors) {
        linear_mm_s += std::abs(motor.linear_mm_s);
        angular_rad_s += std::abs(motor.angular_rad_s);
    }
    robot.model.drives.clear();
    for (auto const& [id, motor] : motors) {
        robot.model.drives.push_back({.motor = id,
                                      .forward = static_cast<std::uint8_t>(motor.forward),
                                      .linear = linear_mm_s > 0.0F ? motor.linear_mm_s / linear_mm_s : 0.0F,
                                      .angular = angular_rad_s > 0.0F ? motor.angular_rad_s / angular_rad_s : 0.0F});
    }
    robot.max_linear_speed_mm_s = linear_mm_s;
    robot.max_angular_speed_rad_s = angular_rad_s;
}

/// A motor that is not there would leave the robot without its push.
void refuse_unknown_motors(MapReader const& map) {
    std::vector<std::string> names;
    std::ranges::transform(kNamedMotors, std::back_inserter(names),
                           [](NamedMotor const& motor) { return std::string(motor.name); });
    for (auto const& [name, value] : map.place().node.entries) {
        Place const place{value, map.path_of(name)};
        if (std::ranges::find(names, name) == names.end()) {
            fail_at(place, fmt::format("expected {}{}", names_text(names), did_you_mean(shown(name), names)));
        }
        if (value.kind == Node::Kind::null) {
            fail_at(place, fmt::format("expected {}, found nothing; remove a motor that is not there", kMotor));
        }
    }
}

/// One number of one motor replaces the whole map, and robots that cannot turn look like a result.
void warn_of_missing_speeds(MapReader const& map, bool is_any_linear, bool is_any_angular) {
    auto const warn = [&](std::string_view key, std::string_view what) {
        log().warn(
            "{}: {}: none of these motors has a value of `{}`, so they cannot {} the robot; a map of motors "
            "replaces the whole one of the robot's type or model. Write {}: 0 in one of them if that is meant",
            map.place().node.where(), map.place().path, key, what, key);
    };
    if (!is_any_linear) {
        warn("linear_mm_s", "move");
    }
    if (!is_any_angular) {
        warn("angular_rad_s", "turn");
    }
}

void read_motors(MapReader& reader, RobotSpec& robot) {
    if (reader.find("motors") == nullptr) {
        return;
    }
    std::vector<std::pair<std::uint8_t, WrittenMotor>> motors;
    reader.read_map("motors", kMotors, [&](MapReader& map) {
        refuse_unknown_motors(map);
        bool is_any_linear = false;
        bool is_any_angular = false;
        for (NamedMotor const& known : kNamedMotors) {
            if (map.find(known.name) == nullptr) {
                continue;
            }
            map.read_map(known.name, [&](MapReader& inner) {
                auto& [id, motor] = motors.emplace_back(known.id, WrittenMotor{.forward = known.forward});
                inner.read(motor_keys(), motor);
                is_any_linear |= inner.find("linear_mm_s") != nullptr;
                is_any_angular |= inner.find("angular_rad_s") != nullptr;
            });
        }
        if (!motors.empty()) {
            warn_of_missing_speeds(map, is_any_linear, is_any_angular);
        }
    });
    set_drives(motors, robot);
}

/// Walls and membranes send along their outlines, and do not drive.
void refuse_parts_of_outline(MapReader const& reader, RobotModel const& model) {
    if (model.sends_along_outline && reader.find("faces") != nullptr) {
        fail_at({*reader.find("faces"), reader.path_of("faces")},
                "walls and membranes send and receive along their whole outline, and have no faces; remove it");
    }
    Node const* const motors = reader.find("motors");
    if (model.sends_along_outline && motors != nullptr && !motors->entries.empty()) {
        fail_at({*motors, reader.path_of("motors")}, "walls and membranes have no motors; remove it");
    }
}

/// Such as faces whose angles were forgotten.
void refuse_equal_faces(MapReader const& reader, std::vector<Face> const& faces) {
    Node const* const list = reader.find("faces");
    for (std::size_t i = 1; list != nullptr && i < faces.size(); ++i) {
        auto const is_equal = [&face = faces[i]](Face const& other) {
            return other.normal == face.normal && other.place == face.place;
        };
        auto const end = faces.begin() + static_cast<std::ptrdiff_t>(i);
        if (auto const equal = std::find_if(faces.begin(), end, is_equal); equal != end) {
            fail_at({list->items[i], fmt::format("{}.{}", reader.path_of("faces"), i)},
                    fmt::format("is where face {} is, and looks the same way; give it an `angle_deg` of its own",
                                equal - faces.begin()));
        }
    }
}

}  // namespace

void read_model(MapReader& reader, RobotSpec& robot) {
    RobotModel& model = robot.model;
    reader.read(part_keys(), robot);
    reader.collect([&] { refuse_parts_of_outline(reader, model); });
    UnitSlips radians;
    auto const face = [&](MapReader& map) {
        look_for_radians(map, radians);
        return read_face(map);
    };
    auto const part = [&](MapReader& map) {
        look_for_radians(map, radians);
        return read_part(map);
    };
    reader.collect([&] {
        read_list(reader, "faces", kFaces, 1, kMostFaces, model.faces, face);
        refuse_equal_faces(reader, model.faces);
    });
    reader.collect([&] { read_list(reader, "leds", kLeds, 0, kLedCount, model.leds, part); });
    reader.collect(
        [&] { read_list(reader, "light_sensors", kSensors, 0, kPhotosensorCount, model.light_sensors, part); });
    radians.warn();
    reader.collect([&] { read_motors(reader, robot); });
    WrittenFlash flash{};
    reader.read(flash_keys(), flash);
    model.flash_pages = flash.pages.value_or(model.flash_pages);
    reader.collect([&] {
        reader.read_map("processor", kProcessor, [&](MapReader& map) { read_processor(map, model.processor); });
    });
}

void warn_of_parts_outside(MapReader const& reader, RobotModel const& model, float radius_mm) {
    constexpr float kRounded = 1.01F;  // places on the rim, as they are written
    if (model.sends_along_outline) {
        return;
    }
    auto const look = [&](char const* key, auto const& parts) {
        Node const* const list = reader.find(key);
        for (std::size_t i = 0; list != nullptr && i < parts.size(); ++i) {
            if (float const distance_mm = length(parts[i].place.offset_mm); distance_mm > kRounded * radius_mm) {
                log().warn(
                    "{}: {}.{}.place: is {:.4g} mm from the centre, outside of the body, whose radius is {:.4g} mm",
                    list->items[i].where(), reader.path_of(key), i, distance_mm, radius_mm);
            }
        }
    };
    look("faces", model.faces);
    look("leds", model.leds);
    look("light_sensors", model.light_sensors);
}

namespace {

/// A speed that both the motors and a key of the category say.
struct ToldSpeed {
    char const* key;
    std::string_view what;  // "the fastest turn"
    std::string_view unit;
    std::string_view verb;  // "turn"
    std::string means;      // what it would be without `motors`, if that is something else
    float of_motors;
    float* chosen;
};

void tell_of_speed(MapReader& reader, ToldSpeed const& speed) {
    Node const* const motors = reader.find("motors");
    Node const* const key = reader.find(speed.key);
    if (motors == nullptr || key == nullptr || *speed.chosen == speed.of_motors) {
        return;
    }
    if (speed.of_motors == 0.0F) {
        log().warn("{}: {}: has no effect, since the `motors` ({}) do not {} the robot", key->where(),
                   reader.path_of(speed.key), motors->where(), speed.verb);
        *speed.chosen = 0.0F;
        reader.set_value(speed.key, value_node(0.0F));
        return;
    }
    // An old configuration that takes a model gets a new meaning unawares, but not one that has written both.
    auto const level = motors->source == key->source ? spdlog::level::info : spdlog::level::warn;
    log().log(level,
              "{}: {}: with `motors` ({}), this is {}, {:.4g} {}{}. Remove it to {} as fast as the motors say, {:.4g} "
              "{}",
              key->where(), reader.path_of(speed.key), motors->where(), speed.what, *speed.chosen, speed.unit,
              speed.means, speed.verb, speed.of_motors, speed.unit);
}

}  // namespace

void tell_of_speeds(MapReader& reader, RobotSpec& robot, MotorSpeeds const& of_motors) {
    constexpr float kTurns = 4.0F;  // of two_wheels(): both against each other
    tell_of_speed(reader, {"max_linear_speed", "the top speed", "mm/s", "move", "", of_motors.linear_mm_s,
                           &robot.max_linear_speed_mm_s});
    tell_of_speed(reader,
                  {"max_angular_speed", "the fastest turn", "rad/s", "turn",
                   fmt::format("; without them, it would be {:.4g} rad/s", kTurns * robot.max_angular_speed_rad_s),
                   of_motors.angular_rad_s, &robot.max_angular_speed_rad_s});
}

std::vector<ModelTable> model_tables() {
    std::vector<KeyDescription> face = described(place_keys(), WrittenPart());
    std::ranges::copy(described(aperture_keys(), WrittenPart()), std::back_inserter(face));
    return {
        {"faces.<number>", "An infrared face.", std::move(face)},
        {"leds.<number>, light_sensors.<number>", "An LED or a light sensor.", described(place_keys(), WrittenPart())},
        {"motors.<right, left or back>", "A motor.", described(motor_keys(), WrittenMotor())},
        {"processor", "The processor of a robot.", described(processor_keys(), ProcessorSpec())},
        {"processor.cycles", "How many clock cycles instructions take. Names are those of the RISC-V manual.",
         described(cycle_keys(), CycleCosts())},
        {"processor.call_times", "How long functions of the robot's library take.",
         described(call_time_keys(), CallTimes())}};
}

}  // namespace pogosim
