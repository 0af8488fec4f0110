#include "brain/script_brain.hpp"

#include <cmath>
#include <cstring>
#include <variant>

#include "brain/driving.hpp"
#include "device/infrared.hpp"
#include "device/leds.hpp"

namespace pogosim {

namespace {

std::int64_t in_us(double time_s) {
    constexpr double us_per_s = 1e6;
    return std::llround(time_s * us_per_s);
}

}  // namespace

ScriptBrain::ScriptBrain(World& world, std::uint32_t category)
    : world_(world),
      range_(robots_of(world, category)),
      script_(std::get<ScriptSpec>(world.categories[category].spec.robot->brain)),
      next_(range_.size()) {}

bool ScriptBrain::run_step() {
    run_due_robots(world_, range_, [this](std::uint32_t robot) { tick(robot); });
    return true;
}

void ScriptBrain::tick(std::uint32_t robot) {
    while (receive(world_, robot)) {
        // It does not listen.
    }
    std::uint32_t& next = next_[robot - range_.first];
    std::int64_t const now_us = world_.devices.clock_us[robot];
    while (next < script_.entries.size() && in_us(script_.entries[next].time_s) <= now_us) {
        carry_out(script_.entries[next++], robot);
    }
}

void ScriptBrain::carry_out(ScriptSpec::Entry const& entry, std::uint32_t robot) {
    for (std::size_t motor = 0; motor < entry.motors.size(); ++motor) {
        if (entry.motors[motor]) {
            set_signed_power(world_, robot, motor, *entry.motors[motor]);
        }
    }
    auto const led = static_cast<std::size_t>(entry.led_id);
    if (entry.led && led < world_.spec_of(robot).model.leds.size()) {
        set_led(world_, robot, led, *entry.led);
    }
    if (!entry.message.empty()) {
        send_message(world_, robot, faces_of_robot(world_, robot), std::as_bytes(std::span(entry.message)));
    }
}

void ScriptBrain::append_state(std::vector<std::byte>& bytes) const {
    auto const raw = std::as_bytes(std::span(next_));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

void ScriptBrain::take_state(std::span<std::byte const>& bytes) {
    std::size_t const size = next_.size() * sizeof(next_[0]);
    std::memcpy(next_.data(), bytes.data(), size);
    bytes = bytes.subspan(size);
}

}  // namespace pogosim
