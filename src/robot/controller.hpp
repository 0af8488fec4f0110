// A robot's own controller: the state of its processor, memory and peripherals between two ticks. Plain data, one per
// robot.
#pragma once

#include <pthread.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "base/random.hpp"
#include "interface/pogobase_inside.hpp"
#include "robot/battery.hpp"
#include "robot/flash.hpp"
#include "robot/phase.hpp"
#include "robot/remote_control.hpp"
#include "world/observed_motion.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Values of the main loop's globals while another robot is running.
struct LoopGlobals {
    std::uint32_t ticks = 0;
    std::uint8_t loop_hz = 60;
    std::uint8_t max_messages_per_tick = 3;
    std::uint8_t send_percent = 20;
    std::int8_t error_led = 3;
    void (*receive)(message_t*) = nullptr;
    bool (*send)() = nullptr;
    std::uint32_t sent = 0;
    std::uint32_t received = 0;
    std::uint32_t milliseconds = 0;
    std::uint32_t error_shown_at_ms = 0;
    time_reference_t global_timer = {};
    time_reference_t loop_timer = {};
};

/// What the program registered for this robot.
struct Program {
    bool registered = false;         // a pogobot_start() named this robot's category
    bool prepared = false;           // pogobot_init() was called
    bool reads_messages = false;     // it looked into its queue, in user code or for msg_rx_fn
    bool decodes_messages = false;   // pogobot_infrared_update() was called
    bool returned = false;           // main() of a program for the SDK has ended
    std::optional<unsigned> seed{};  // of its last srand()
    void (*init)() = nullptr;
    void (*step)() = nullptr;
    void (*export_data)() = nullptr;
    void (*end)() = nullptr;
    void (*click)() = nullptr;
};

/// Calls of msg_tx_fn in which messages were sent, and which said so.
struct SendResults {
    std::uint64_t sent = 0;
    std::uint64_t said = 0;
};

inline constexpr int kMotorCount = 3;  // right, left, back: the order of motor_id

struct Motors {
    std::array<std::uint16_t, kMotorCount> power{};
    std::array<std::uint8_t, kMotorCount> direction{0, 1, 0};
    std::array<std::uint8_t, kMotorCount> stored_direction{0, 1, 0};
    std::array<std::uint16_t, kMotorCount> stored_power{512, 512, 0};
    float bias = 0.0F;    // PWM units: left + bias, right - bias
    bool driven = false;  // a motor function was called: the motors impose a velocity from now on
};

inline constexpr int kPhotosensorCount = 3;  // back, front left, front right

/// How the body moved at the last two ticks, or in the last two steps, for the accelerometer.
struct Accelerometer {
    BodyStep previous;
    BodyStep current;
    float interval_s = 0.0F;  // between the two; 0 before the second
    bool has_measured = false;
    bool at_each_step = false;    // not at ticks
    std::int64_t current_us = 0;  // the robot's clock at the last tick, or the time of the step
};

/// What the program has read of the magnetometer.
struct Magnetometer {
    std::uint64_t samples = 0;           // how often it has read new data
    std::array<std::int16_t, 3> last{};  // x, y, z
    bool did_not_wait = false;           // timing at_once: its last call had no time to wait
    std::int64_t taken = 0;              // data_number() of the last ones
};

/// How often it sends, where no main loop knows that: since the window before the present one began.
struct SentRate {
    std::int64_t before_us = 0;  // when that was
    std::int64_t began_us = 0;   // of the present window
    std::int64_t last_us = -1;   // when it sent last
    std::uint32_t before = 0;    // times at which it sent, of each
    std::uint32_t present = 0;
};

/// The stream of rand() with which a robot's program starts.
inline RandomStream random_of_program(std::uint64_t seed, std::uint32_t robot) {
    constexpr std::uint64_t first_stream = std::uint64_t{1} << 32U;
    return {seed, first_stream + robot};
}

class Fiber;

// What a clock shows of a robot that is not due, us.
inline constexpr std::int64_t kNever = std::int64_t{1} << 62U;  // switched off; room for what a callback may add to it
inline constexpr std::int64_t kIdle = kNever / 2;               // its main() has returned

struct Controller {
    std::int64_t clock_us = 0;        // the robot's own time
    std::int64_t clock_drift_us = 0;  // added at every tick
    std::int64_t went_on_us = 0;      // its time when it got the processor
    int calls = 0;                    // of what programs wait with in a loop, see waiting.hpp
    Fiber* fiber = nullptr;           // on which its program waits in the middle; null: it does not
    Phase waits_in = Phase::none;
    bool is_restart_due = false;       // at the beginning of the next step
    int waits = 0;                     // in the call of its program that runs
    std::int64_t call_began_us = 0;    // when that began; time of the step
    std::uint32_t call_ticks = 0;      // pogobot_ticks then
    std::int64_t longest_call_us = 0;  // of those that have waited and returned
    pthread_t waits_on{};              // the thread in which it began to
    Program program;
    std::byte* user_data = nullptr;
    LoopGlobals loop;
    Motors motors;
    Flash flash;
    Accelerometer accelerometer;
    Magnetometer magnetometer;
    Battery battery;
    std::array<std::int32_t, kPhotosensorCount> photosensor_bias{};
    RandomStream imu_noise;
    std::uint8_t ir_power = 1;
    InfraredState infrared;
    std::uint64_t messages_sent = 0;  // by whatever function
    SendResults send_results;
    SentRate sent_rate;
    std::uint64_t messages_received = 0;  // taken out of its queue
    RandomStream random;                  // rand() and srand() of the program
    RandomStream seeds;                   // getRandSeed(), from the second call on
    std::int16_t first_seed = 0;          // its first answer, different on every robot
    bool seed_taken = false;
    std::string printed;  // a line not yet complete
};

}  // namespace pogosim
