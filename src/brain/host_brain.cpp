#include "brain/host_brain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "base/log.hpp"
#include "brain/driving.hpp"
#include "device/battery.hpp"
#include "device/infrared.hpp"
#include "device/leds.hpp"
#include "device/sensing.hpp"
#include "device/sensors.hpp"

namespace pogosim {

namespace {

constexpr std::int32_t kNoMessage = -1;
constexpr std::int8_t kAllDirections = -1;
constexpr std::int16_t kNoSensor = -1;
constexpr std::uint32_t kAtATime = 64;  // robots, whose cells of the light map stay in the cache

}  // namespace

HostBrain::HostBrain(World& world, std::string_view category, RobotRange robots)
    : world_(world), category_(category), range_(robots) {
    std::size_t const count = range_.size();
    inputs_ = {.motors = std::vector(count, std::array<std::int32_t, kMotorCount>{}),
               .leds = std::vector(count, Leds{}),
               .send_bytes = std::vector(count, std::array<std::byte, kMostPayloadBytes>{}),
               .send_length = std::vector(count, kNoMessage),
               .send_face = std::vector(count, kAllDirections)};
    std::array<std::int16_t, kPhotosensorCount> none{};
    none.fill(kNoSensor);
    outputs_ = {.photosensors = std::vector(count, none),
                .acceleration = std::vector(count, std::array<float, 3>{}),
                .angular_velocity = std::vector(count, std::array<float, 3>{}),
                .battery_mv = std::vector(count, std::int16_t{0}),
                .received_count = std::vector(count, 0U)};
    light_cells_.resize(count);
    for (std::uint32_t robot = robots.first; robot < robots.last; ++robot) {
        most_received_ += static_cast<std::size_t>(world.spec_of(robot).ir.queue_size);
    }
    received_ = std::make_unique_for_overwrite<Received[]>(most_received_);
    received_bytes_ = std::make_unique_for_overwrite<std::byte[]>(most_received_ * kMostPayloadBytes);
}

bool HostBrain::run_step() {
    for (std::uint32_t first = range_.first; first < range_.last; first += kAtATime) {
        RobotRange const some{.first = first, .last = std::min(first + kAtATime, range_.last)};
        expect(some);
        run_due_robots(world_, some, [this](std::uint32_t robot) { tick(robot); });
    }
    return true;
}

/// Finds the cells of the light map at the sensors of the robots that are due, and prefetches what they will read:
/// with many runs, none of it is in the cache, and one miss after the other would take longer than all that follows.
void HostBrain::expect(RobotRange robots) {
    std::int64_t const now_us = time_us(world_);
    for (std::uint32_t robot = robots.first; robot < robots.last; ++robot) {
        world_.mailboxes.expect_push(robot);
        if (now_us < world_.devices.clock_us[robot] || world_.robots.body[robot] == kNone) {
            continue;
        }
        auto& cells = light_cells_[robot - range_.first];
        for (std::size_t sensor = 0; sensor < world_.spec_of(robot).model.light_sensors.size(); ++sensor) {
            cells[sensor] = light_cell_at_sensor(world_, robot, sensor);
            __builtin_prefetch(&world_.light.level[cells[sensor]]);
        }
    }
}

void HostBrain::tick(std::uint32_t robot) {
    std::uint32_t const i = robot - range_.first;
    set_motors(robot, inputs_.motors[i]);
    for (std::size_t led = 0; led < world_.spec_of(robot).model.leds.size(); ++led) {
        set_led(world_, robot, led, inputs_.leds[i][led]);
    }
    read_sensors(robot);
    take_messages(robot);
    send(robot);
}

void HostBrain::set_motors(std::uint32_t robot, std::array<std::int32_t, kMotorCount> const& powers) {
    bool const is_driven = world_.devices.motors[robot].driven;
    if (!is_driven && std::ranges::all_of(powers, [](std::int32_t power) { return power == 0; })) {
        return;
    }
    for (std::size_t motor = 0; motor < kMotorCount; ++motor) {
        std::int32_t const power = powers[motor];
        set_signed_power(world_, robot, motor, power);
        std::int32_t const most = kFullMotorPower;
        if (power != 0 && !world_.spec_of(robot).model.has_motor(static_cast<int>(motor))) [[unlikely]] {
            warn_once(
                TooMuch::motor,
                fmt::format("motors[:, {}]: the robots' model has no such motor; its power moves nothing", motor));
        }
        if (power > most || power < -most) [[unlikely]] {
            warn_once(TooMuch::power,
                      fmt::format("motors[{}, {}] is {}, expected -{} to {}; {} is used", robot - range_.first, motor,
                                  power, most, most, power < 0 ? -most : most));
        }
    }
}

void HostBrain::warn_once(TooMuch which, std::string_view what) {
    bool& warned = warned_[static_cast<std::size_t>(which)];
    if (!warned) {
        warned = true;
        log().warn("brain of category '{}': {}", category_, what);
    }
}

void HostBrain::send(std::uint32_t robot) {
    std::uint32_t const i = robot - range_.first;
    std::int32_t const length = inputs_.send_length[i];
    if (length < 0) {
        return;
    }
    inputs_.send_length[i] = kNoMessage;
    int const face = inputs_.send_face[i];
    std::uint8_t const all = faces_of_robot(world_, robot);
    bool const is_to_one = face >= 0 && face < static_cast<int>(kMostFaces);
    if (!is_to_one && face != kAllDirections) [[unlikely]] {
        warn_once(TooMuch::face, fmt::format("send_face[{}] is {}, expected -1 to {}; all directions are used", i, face,
                                             kMostFaces - 1));
    }
    auto const emitters = is_to_one ? static_cast<std::uint8_t>(all & 1U << face) : all;
    if (emitters == 0) [[unlikely]] {
        warn_once(TooMuch::face_of_model,
                  fmt::format("send_face: the robots' model has no face {}; nothing is sent", face));
        return;
    }
    auto const size = std::min(static_cast<std::size_t>(length), kMostPayloadBytes);
    if (static_cast<std::size_t>(length) > kMostPayloadBytes) [[unlikely]] {
        warn_once(TooMuch::length, fmt::format("send_length[{}] is {}, expected at most {} bytes; {} are sent", i,
                                               length, kMostPayloadBytes, kMostPayloadBytes));
    }
    send_message(world_, robot, emitters, std::span<std::byte const>(inputs_.send_bytes[i]).first(size));
}

void HostBrain::read_sensors(std::uint32_t robot) {
    std::uint32_t const i = robot - range_.first;
    outputs_.battery_mv[i] = battery_voltage_mv(world_, robot);
    if (world_.robots.body[robot] == kNone) {
        return;
    }
    for (std::size_t sensor = 0; sensor < world_.spec_of(robot).model.light_sensors.size(); ++sensor) {
        int const light = world_.light.level[light_cells_[i][sensor]];
        outputs_.photosensors[i][sensor] = read_photosensor(world_, robot, sensor, light);
    }
    ImuReading const reading = read_imu(world_, robot);
    outputs_.acceleration[i] = reading.acceleration;
    outputs_.angular_velocity[i] = reading.angular_velocity;
}

void HostBrain::take_messages(std::uint32_t robot) {
    constexpr std::size_t most_bytes = std::numeric_limits<std::int32_t>::max();  // that offsets can say
    while (received_count_ < most_received_ && used_bytes_ + kMostPayloadBytes <= most_bytes) {
        std::optional<Message> const message = receive(world_, robot);
        if (!message) {
            return;
        }
        received_[received_count_++] = {.robot = static_cast<std::int32_t>(robot - range_.first),
                                        .sender = message->header.sender_id,
                                        .face = message->header.receiver_ir_index,
                                        .length = message->header.payload_length,
                                        .offset = static_cast<std::int32_t>(used_bytes_)};
        std::ranges::copy(message->payload, received_bytes_.get() + used_bytes_);
        used_bytes_ += message->payload.size();
        ++outputs_.received_count[robot - range_.first];
    }
}

void HostBrain::clear_received() {
    received_count_ = used_bytes_ = 0;
    std::ranges::fill(outputs_.received_count, 0U);
}

template <class Self, class Visit>
void HostBrain::visit_state(Self& brain, Visit const& visit) {
    visit(std::span(brain.inputs_.motors));
    visit(std::span(brain.inputs_.leds));
    visit(std::span(brain.inputs_.send_bytes));
    visit(std::span(brain.inputs_.send_length));
    visit(std::span(brain.inputs_.send_face));
    visit(std::span(brain.outputs_.photosensors));
    visit(std::span(brain.outputs_.acceleration));
    visit(std::span(brain.outputs_.angular_velocity));
    visit(std::span(brain.outputs_.battery_mv));
    visit(std::span(brain.outputs_.received_count));
    visit(std::span(&brain.received_count_, 1));
    visit(std::span(&brain.used_bytes_, 1));
    visit(std::span(brain.received_.get(), brain.received_count_));
    visit(std::span(brain.received_bytes_.get(), brain.used_bytes_));
}

void HostBrain::append_state(std::vector<std::byte>& bytes) const {
    visit_state(*this, [&](auto const values) {
        auto const raw = std::as_bytes(values);
        bytes.insert(bytes.end(), raw.begin(), raw.end());
    });
}

void HostBrain::take_state(std::span<std::byte const>& bytes) {
    visit_state(*this, [&](auto const values) {
        std::memcpy(values.data(), bytes.data(), values.size_bytes());
        bytes = bytes.subspan(values.size_bytes());
    });
}

}  // namespace pogosim
