// What a robot that runs firmware has of its own: processor, memory, and what its library keeps for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "device/random_seeds.hpp"
#include "riscv/core.hpp"
#include "riscv/memory_image.hpp"

namespace pogosim {

struct FirmwareRobot {
    Core core;
    Memory memory;
    RandomSeeds seeds;
    RandomStream random;  // of rand(), where that is the simulator's
    std::string printed;  // a line that is not complete

    std::int64_t went_on_us = 0;       // its clock when its tick began; without a main loop: when it got the processor
    int calls = 0;                     // since it slept, see note_call()
    std::int64_t tick_step = -1;       // step of the world in which its last tick began
    std::optional<bool> finds_data{};  // a call waits for data of the magnetometer, and will find some or not
    bool is_starting = false;          // its main loop has not begun; false without one
    bool is_ending_tick = false;       // its main loop has slept, and has not begun the next tick
    bool is_drift_due = false;         // its tick has begun, and its clock has not drifted since
    bool was_cut_off = false;          // it has run for as long as it might, in the middle of its code
    int timer_resets = 0;              // of timer_main_loop while it is starting
    bool ends_tick = false;            // it has read timer_main_loop, and called nothing since
    bool has_noted_call = false;       // the call that it is about to make waits since it was noted
    bool has_ended = false;            // it does nothing any more
    bool is_restart_due = false;       // at the beginning of its next step
    bool is_stack_above = false;       // at its first call, its stack was above its variables
    bool has_called = false;

    std::uint64_t tick_began_cycles = 0;  // cycles of the core when its last tick began
    std::uint64_t tick_cycles = 0;        // of the tick before

    // Where time is counted.
    std::uint64_t timed_cycles = 0;  // cycles of the core for which its clock has gone on
    double rest_us = 0.0;            // less than a microsecond, for which it has not

    /// Whether it goes on though its clock is ahead of the run's.
    bool runs_ahead() const { return is_starting || is_ending_tick; }

    explicit FirmwareRobot(std::shared_ptr<MemoryImage const> image) : memory(std::move(image)) {}
};

/// Appends the state of a robot as bytes: for hashes, and to go on from there.
void save_robot(FirmwareRobot const& robot, std::vector<std::byte>& bytes);

/// Takes the bytes of one robot from the front of `bytes`. `robot`: as it is at the start of a run.
void restore_robot(FirmwareRobot& robot, std::span<std::byte const>& bytes);

}  // namespace pogosim
