// What drives robots: a C program, arrays of a host, or a script. A brain drives the robots of some categories; it sees
// the world through the functions of `device`, so that time, messages, rows and pictures are the same whatever drives a
// robot. There is one virtual call for each brain and step, not for each robot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/state_bytes.hpp"
#include "process/crash_handler.hpp"
#include "process/variable_text.hpp"
#include "world/data_table.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Robots with consecutive indices in World::robots: those of one category.
struct RobotRange {
    std::uint32_t first = 0;
    std::uint32_t last = 0;  // exclusive

    std::uint32_t size() const { return last - first; }
    bool contains(std::uint32_t robot) const { return robot >= first && robot < last; }
};

/// The robots of a category.
RobotRange robots_of(World const& world, std::uint32_t category);

/// A copy of a brain's state, for Brain::restore().
struct SavedBrain {
    virtual ~SavedBrain() = default;
    /// The memory that it takes, about.
    virtual std::size_t byte_count() const = 0;
};

class Brain {
public:
    Brain() = default;
    virtual ~Brain() = default;
    Brain(Brain const&) = delete;
    Brain& operator=(Brain const&) = delete;

    // These functions return false if user code has failed, which ends the run.

    /// Before the first step.
    virtual bool start() { return true; }

    /// All its robots whose clocks are due take a tick, in their order: they read sensors, take messages out of their
    /// mailboxes, set motors and LEDs, and put messages on the air. Their clocks then show when the next tick is due.
    virtual bool run_step() = 0;

    /// After the last step.
    virtual bool stop() { return true; }

    /// Adds its columns to those of the data file. Throws ConfigError.
    virtual void declare_columns(std::vector<ColumnSpec>& /*columns*/) {}

    /// Fills the cells of its columns in the row of a robot, if it drives that robot.
    virtual void fill_row(std::uint32_t /*robot*/, std::span<CellValue> /*cells*/) const {}

    /// What the user may want to see of a robot that it drives: the load of its processor, and variables.
    virtual NamedTexts texts_of(std::uint32_t /*robot*/) const { return {}; }

    /// The highest rate of ticks that one of its robots asks for, 1/s; 0: none says.
    virtual int highest_loop_hz() const { return 0; }

    /// Why the last of these functions returned false.
    virtual std::optional<UserFailure> failure() const { return std::nullopt; }

    /// Copies its own state, which is not in the world.
    virtual std::unique_ptr<SavedBrain> save();

    /// Goes on from a state of this brain.
    virtual void restore(SavedBrain const& saved);

    /// Why its state cannot be copied; empty: it can.
    virtual std::string why_not_saved() const { return {}; }

    /// Appends the state as bytes that are the same in every process, for hashes, and unless the brain saves itself
    /// otherwise, for take_state(), which takes them from the front of `bytes`.
    virtual void append_state(std::vector<std::byte>& /*bytes*/) const {}
    virtual void take_state(std::span<std::byte const>& /*bytes*/) {}

    /// The state for another process that drives the same robots, and what goes on from it, after start(). Throws
    /// ConfigError if there is something that only this process has, and ForeignState.
    virtual void append_for_process(StateWriter& state);
    virtual void take_from_process(StateReader& state);

    /// Why the former cannot be called: at no time, or not between these two steps; empty: it can.
    virtual std::string why_never_for_process() const { return why_not_saved(); }
    virtual std::string why_not_now_for_process() const { return {}; }
};

/// All of a run. A program in C comes first, then others by their categories.
using Brains = std::vector<std::unique_ptr<Brain>>;

}  // namespace pogosim
