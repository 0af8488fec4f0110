// What robots have besides a body: clocks, motors, sensors, memory and infrared ports. Plain data in structures of
// arrays; the functions of src/device read and write it, whatever drives the robot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/random.hpp"
#include "base/vec2.hpp"
#include "world/robot_model.hpp"

namespace pogosim {

struct Motors {
    std::array<std::uint16_t, kMotorCount> power{};
    std::array<std::uint8_t, kMotorCount> direction{0, 1, 0};
    std::array<std::uint8_t, kMotorCount> stored_direction{0, 1, 0};
    std::array<std::uint16_t, kMotorCount> stored_power{512, 512, 0};
    float bias = 0.0F;    // PWM units: left + bias, right - bias
    bool driven = false;  // a motor function was called: the motors impose a velocity from now on

    friend bool operator==(Motors const&, Motors const&) = default;
};

using PhotosensorBias = std::array<std::int32_t, kPhotosensorCount>;

/// A step of a body. Accelerometers note one for every robot and tick; its velocity is computed only when it is read.
struct BodyStep {
    Vec2 start_mm;
    Vec2 end_mm;
    Vec2 engine_mm_s;  // the engine's velocity after it

    friend bool operator==(BodyStep const&, BodyStep const&) = default;
};

/// How the body moved at the last two ticks, or in the last two steps, for the accelerometer.
struct Accelerometer {
    BodyStep previous;
    BodyStep current;
    float interval_s = 0.0F;  // between the two; 0 before the second
    bool has_measured = false;
    bool at_each_step = false;    // not at ticks
    std::int64_t current_us = 0;  // the robot's clock at the last tick, or the time of the step

    friend bool operator==(Accelerometer const&, Accelerometer const&) = default;
};

/// What has been read of the magnetometer.
struct Magnetometer {
    std::uint64_t samples = 0;           // how often new data were read
    std::array<std::int16_t, 3> last{};  // x, y, z
    bool did_not_wait = false;           // timing at_once: the last call had no time to wait
    std::int64_t taken = 0;              // data_number() of the last ones

    friend bool operator==(Magnetometer const&, Magnetometer const&) = default;
};

struct Battery {
    double used_mas = 0.0;  // charge taken out of it, mA s

    friend bool operator==(Battery const&, Battery const&) = default;
};

inline constexpr std::size_t kFlashPageBytes = 256;
inline constexpr std::uint32_t kFlashPageCount = 5888;
inline constexpr std::byte kErased{0xFF};

using FlashPage = std::array<std::byte, kFlashPageBytes>;

/// The user's section of a robot's flash memory. Only pages that are not blank take memory, so a robot that never
/// writes has none.
struct Flash {
    std::vector<std::uint16_t> slot{};  // of each page: 1 + its index in `pages`, 0 for a blank one; empty: all blank
    std::vector<FlashPage> pages{};     // in the order of their first write
    std::uint64_t lost_writes = 0;      // after which a page did not contain what was written, see program_page()

    /// See state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.slot, self.pages, self.lost_writes);
    }

    friend bool operator==(Flash const&, Flash const&) = default;
};

/// The infrared state of one robot. Initialising the hardware makes it anew, but for the counts of the whole run.
struct InfraredState {
    std::uint8_t is_muted = 0;           // not 0: functions that send return an error; the program may write it, too
    std::uint64_t dropped_before = 0;    // Mailboxes::dropped() when it was initialised
    std::uint64_t malformed_before = 0;  // Mailboxes::malformed() then
    std::uint64_t muted_messages = 0;    // that were not sent, in the whole run
    std::uint32_t restarts = 0;          // in the whole run

    friend bool operator==(InfraredState const&, InfraredState const&) = default;
};

/// How often it sends, where no main loop knows that: since the window before the present one began.
struct SentRate {
    std::int64_t before_us = 0;  // when that was
    std::int64_t began_us = 0;   // of the present window
    std::int64_t last_us = -1;   // when it sent last
    std::uint32_t before = 0;    // times at which it sent, of each
    std::uint32_t present = 0;

    friend bool operator==(SentRate const&, SentRate const&) = default;
};

inline constexpr std::uint8_t kUsualIrPower = 1;

// What a clock shows of a robot that is not due, us.
inline constexpr std::int64_t kNever = std::int64_t{1} << 62U;  // switched off; room for what a callback may add to it
inline constexpr std::int64_t kIdle = kNever / 2;               // its program has ended

/// Shape: one entry per robot, and one behind the last robot: callback_global_step has a clock, motors and memory as a
/// robot has, and no body. See set_up_devices().
struct Devices {
    std::vector<std::int64_t> clock_us;        // the robot's own time
    std::vector<std::int64_t> clock_drift_us;  // added at every tick
    std::vector<Motors> motors;
    std::vector<PhotosensorBias> photosensor_bias;
    std::vector<Accelerometer> accelerometer;
    std::vector<RandomStream> imu_noise;
    std::vector<Magnetometer> magnetometer;
    std::vector<Battery> battery;
    std::vector<Flash> flash;
    std::vector<std::uint8_t> ir_power;
    std::vector<InfraredState> infrared;
    std::vector<SentRate> sent_rate;
    std::vector<std::uint32_t> ticks;          // how often it has ticked; of a program, what pogobot_ticks said last
    std::vector<std::uint64_t> messages_sent;  // by whatever function
    std::vector<std::uint64_t> messages_received;  // taken out of its queue
    std::int64_t drained_us = 0;                   // time up to which batteries have given what was used

    std::size_t size() const { return clock_us.size(); }

    friend bool operator==(Devices const&, Devices const&) = default;
};

}  // namespace pogosim
