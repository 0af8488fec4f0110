// What belongs to the program of one robot between two of its ticks: callbacks, variables of the main loop, user data.
// Its clock, motors, sensors and infrared port are in World::devices.
#pragma once

#include <pthread.h>

#include <cstdint>
#include <optional>
#include <string>

#include "base/random.hpp"
#include "device/random_seeds.hpp"
#include "interface/pogobase_inside.hpp"
#include "robot/phase.hpp"

namespace pogosim {

/// Values of the main loop's globals while another robot is running.
struct LoopGlobals {
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

class Fiber;
class FunctionTimes;

struct Controller {
    std::int64_t went_on_us = 0;  // its time when it got the processor
    int calls = 0;                // of what programs wait with in a loop, see waiting.hpp
    Fiber* fiber = nullptr;       // on which its program waits in the middle; null: it does not
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
    SendResults send_results;
    RandomStream random;  // rand() and srand() of the program
    RandomSeeds seeds;
    std::string printed;                   // a line not yet complete
    FunctionTimes const* times = nullptr;  // null: its code takes no time
    double rest_us = 0.0;                  // less than a microsecond, for which its clock has not gone on
    double polled_us = 0.0;                // of its clock, in loops of the call that runs now
};

}  // namespace pogosim
