// Looks into single robots, for the window.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "comms/visibility.hpp"
#include "process/program_variables.hpp"
#include "render/inspection.hpp"
#include "robot/controllers.hpp"
#include "robot/printed_lines.hpp"
#include "sim/recent_motion.hpp"
#include "sim/recorded_rows.hpp"
#include "sim/touching.hpp"
#include "world/world.hpp"

namespace pogosim {

class Inspector {
public:
    /// References outlive this. `gaps`: of the engine.
    Inspector(World const& world, Controllers const& controllers, Brains const& brains, TouchGaps const& gaps)
        : world_(world),
          controllers_(controllers),
          brains_(brains),
          gaps_(gaps),
          recent_motion_(world),
          lines_(world.robots.size()),
          rows_(world.robots.size()) {}

    /// Call it after each step.
    void note_step() { recent_motion_.follow(world_); }

    /// Motion begins anew.
    void forget() { recent_motion_ = RecentMotion(world_); }

    /// The state of a robot between two steps. Reads only: no user code runs, and no random stream is used.
    Inspection inspect(std::uint32_t robot);

    // Filled during the run.
    PrintedLines& lines() { return lines_; }
    RecordedRows& rows() { return rows_; }

private:
    std::vector<Neighbour> neighbours_of(std::uint32_t robot);
    std::vector<std::string> names_of_touched(Object const& object) const;
    void add_variables(std::uint32_t robot, Inspection& inspection);

    World const& world_;
    Controllers const& controllers_;
    Brains const& brains_;
    TouchGaps gaps_;
    RecentMotion recent_motion_;
    Visibility visibility_;
    std::optional<ProgramVariables> variables_;  // from the first look at them on
    PrintedLines lines_;
    RecordedRows rows_;
};

}  // namespace pogosim
