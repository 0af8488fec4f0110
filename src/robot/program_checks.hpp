// Warnings about probable mistakes in the user's program, at the start and at the end of a run. Each is about something
// that no correct program does; mistakes of one robot at one tick are reported where they happen
// (RunServices::warn_once).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "robot/context.hpp"
#include "robot/controller.hpp"
#include "world/data_table.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Memory of the robots that have least, for the following.
std::size_t least_memory_bytes(World const& world);

/// Variables too large for a real robot. `what`: "USERDATA has"; `bytes`: of one robot.
void warn_of_large_memory(std::string_view what, std::size_t bytes, std::size_t memory_bytes);

/// Allocations of all `robots` together in main() and user_init, on average too large for a real robot.
void warn_of_large_heap(std::size_t allocated_bytes, std::size_t robots, std::size_t memory_bytes);

/// All the memory that a robot needs, too large for a real one. `variables`: USERDATA, or its own copies of the
/// program's variables; `stack`: how much of one was used, at most.
void warn_of_large_stack(std::size_t variables, std::size_t stack, std::size_t memory_bytes);

/// A callback_global_setup that has changed USERDATA. `id`: of the one robot that it belongs to.
void warn_of_user_data_in_setup(std::uint32_t id);

/// Categories without a pogobot_start(). `started`: those that the program's calls do name.
void warn_of_idle_categories(World const& world, std::span<Controller const> controllers,
                             std::span<std::string const> started);

/// A program that has never called pogobot_init(), not even in user_init.
void warn_of_missing_init(std::span<Controller const> controllers);

/// Robots that have all called srand() with the same seed, and so draw the same random numbers.
void warn_of_equal_seeds(std::span<Controller const> controllers);

/// A msg_tx_fn that sends, and always says that it has not.
void warn_of_send_results(std::span<Controller const> controllers);

/// Columns of the data file that cannot be filled.
void warn_of_empty_columns(std::span<ColumnSpec const> columns, std::span<Controller const> controllers);

/// Columns that the program's callback left empty in all of its rows. `fields`: the columns that the data file has;
/// absent: all.
void tell_of_unset_columns(DataExport const& data, std::optional<std::vector<std::string>> const& fields);

/// Messages dropped because the queue of a robot that reads messages was full, by category.
void warn_of_lost_messages(World const& world, std::span<Controller const> controllers);

/// Messages that robots did not send because they were muted, and restarts, by category.
void warn_of_commands(World const& world);

/// Messages that are never read, or that a program intends to send and read but cannot. `arrivals`: messages that
/// reached robots in the whole run.
void warn_of_unused_messages(World const& world, std::span<Controller const> controllers, std::uint64_t arrivals);

/// A program that reads messages and never has them decoded.
void warn_of_undecoded_messages(std::span<Controller const> controllers);

/// Under `flash: nor`, writes to pages that were not erased, by category, if there were several.
void tell_of_lost_flash_writes(World const& world);

/// Programs for the SDK whose main() has returned.
void tell_of_ended_programs(std::span<Controller const> controllers);

inline constexpr int kMostSendPercent = 100;

/// Robots sleep whole milliseconds between ticks. `loop_hz`: above 0.
inline double seconds_between_ticks(int loop_hz) {
    constexpr int milliseconds = 1000;
    return static_cast<double>(milliseconds / loop_hz) / milliseconds;
}

/// Whether a robot with this main_loop_hz cannot tick as often as it should: it does so at most once per step.
inline bool skips_ticks(int loop_hz, double time_step_s) {
    return loop_hz > 0 && time_step_s > seconds_between_ticks(loop_hz);
}

/// Whether variables of the main loop have values that cannot be followed. `most_loop_hz`: without skipping ticks.
inline bool are_odd(LoopGlobals const& loop, int most_loop_hz) {
    return loop.send_percent > kMostSendPercent || loop.error_led >= static_cast<int>(kLedCount) ||
           loop.loop_hz > most_loop_hz;
}

/// Warns of them, for the running robot.
void note_loop_globals(World const& world, LoopGlobals const& loop, int most_loop_hz);

}  // namespace pogosim
