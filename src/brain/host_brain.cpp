#include "brain/host_brain.hpp"

#include <algorithm>
#include <cstring>

#include "brain/signed_power.hpp"
#include "brain/ticks.hpp"
#include "device/battery.hpp"
#include "device/imu.hpp"
#include "device/infrared.hpp"
#include "device/leds.hpp"
#include "device/photosensors.hpp"

namespace pogosim {

namespace {

constexpr std::int32_t kNoMessage = -1;
constexpr std::int8_t kAllDirections = -1;
constexpr std::int16_t kNoSensor = -1;

template <class T>
void append(std::vector<std::byte>& bytes, std::span<T const> values) {
    auto const raw = std::as_bytes(values);
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

template <class T>
void take(std::span<std::byte const>& bytes, std::span<T> values) {
    std::memcpy(values.data(), bytes.data(), values.size_bytes());
    bytes = bytes.subspan(values.size_bytes());
}

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
    for (std::uint32_t robot = robots.first; robot < robots.last; ++robot) {
        most_received_ += static_cast<std::size_t>(world.spec_of(robot).ir.queue_size);
    }
    received_ = std::make_unique_for_overwrite<Received[]>(most_received_);
    received_bytes_ = std::make_unique_for_overwrite<std::byte[]>(most_received_ * kMostPayloadBytes);
}

bool HostBrain::run_step() {
    run_due_robots(world_, range_, [this](std::uint32_t robot) { tick(robot); });
    return true;
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
        set_signed_power(world_, robot, motor, powers[motor]);
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
    auto const emitters = is_to_one ? static_cast<std::uint8_t>(all & 1U << face) : all;
    auto const size = std::min(static_cast<std::size_t>(length), kMostPayloadBytes);
    send_message(world_, robot, emitters, std::span<std::byte const>(inputs_.send_bytes[i]).first(size));
}

void HostBrain::read_sensors(std::uint32_t robot) {
    std::uint32_t const i = robot - range_.first;
    outputs_.battery_mv[i] = battery_voltage_mv(world_, robot);
    if (world_.robots.body[robot] == kNone) {
        return;
    }
    for (std::size_t sensor = 0; sensor < world_.spec_of(robot).model.light_sensors.size(); ++sensor) {
        outputs_.photosensors[i][sensor] = read_photosensor(world_, robot, sensor);
    }
    ImuReading const reading = read_imu(world_, robot);
    outputs_.acceleration[i] = reading.acceleration;
    outputs_.angular_velocity[i] = reading.angular_velocity;
}

void HostBrain::take_messages(std::uint32_t robot) {
    FrameHeader header;
    while (received_count_ < most_received_ && !world_.mailboxes.empty(robot)) {
        std::span const place(received_bytes_.get() + used_bytes_, kMostPayloadBytes);
        receive(world_, robot, header, place);
        received_[received_count_++] = {.robot = static_cast<std::int32_t>(robot - range_.first),
                                        .sender = header.sender_id,
                                        .face = header.receiver_ir_index,
                                        .length = header.payload_length,
                                        .offset = static_cast<std::int32_t>(used_bytes_)};
        used_bytes_ += header.payload_length;
        ++outputs_.received_count[robot - range_.first];
    }
}

void HostBrain::clear_received() {
    received_count_ = used_bytes_ = 0;
    std::ranges::fill(outputs_.received_count, 0U);
}

void HostBrain::save(std::vector<std::byte>& bytes) const {
    append<std::array<std::int32_t, kMotorCount>>(bytes, inputs_.motors);
    append<Leds>(bytes, inputs_.leds);
    append<std::array<std::byte, kMostPayloadBytes>>(bytes, inputs_.send_bytes);
    append<std::int32_t>(bytes, inputs_.send_length);
    append<std::int8_t>(bytes, inputs_.send_face);
    append<std::array<std::int16_t, kPhotosensorCount>>(bytes, outputs_.photosensors);
    append<std::array<float, 3>>(bytes, outputs_.acceleration);
    append<std::array<float, 3>>(bytes, outputs_.angular_velocity);
    append<std::int16_t>(bytes, outputs_.battery_mv);
    append<std::uint32_t>(bytes, outputs_.received_count);
    append<std::size_t>(bytes, std::array{received_count_, used_bytes_});
    append<Received>(bytes, received());
    append<std::byte>(bytes, received_bytes());
}

void HostBrain::restore(std::span<std::byte const>& bytes) {
    take<std::array<std::int32_t, kMotorCount>>(bytes, inputs_.motors);
    take<Leds>(bytes, inputs_.leds);
    take<std::array<std::byte, kMostPayloadBytes>>(bytes, inputs_.send_bytes);
    take<std::int32_t>(bytes, inputs_.send_length);
    take<std::int8_t>(bytes, inputs_.send_face);
    take<std::array<std::int16_t, kPhotosensorCount>>(bytes, outputs_.photosensors);
    take<std::array<float, 3>>(bytes, outputs_.acceleration);
    take<std::array<float, 3>>(bytes, outputs_.angular_velocity);
    take<std::int16_t>(bytes, outputs_.battery_mv);
    take<std::uint32_t>(bytes, outputs_.received_count);
    std::array<std::size_t, 2> counts{};
    take<std::size_t>(bytes, counts);
    received_count_ = counts[0];
    used_bytes_ = counts[1];
    take<Received>(bytes, {received_.get(), received_count_});
    take<std::byte>(bytes, {received_bytes_.get(), used_bytes_});
}

}  // namespace pogosim
