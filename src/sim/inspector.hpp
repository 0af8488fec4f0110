// What a window shows of single robots.
#pragma once

#include <cstdint>

#include "comms/visibility.hpp"
#include "render/inspection.hpp"
#include "robot/controllers.hpp"
#include "robot/printed_lines.hpp"
#include "sim/recorded_rows.hpp"
#include "world/world.hpp"

namespace pogosim {

class Inspector {
public:
    /// References outlive this.
    Inspector(World const& world, Controllers const& controllers)
        : world_(world), controllers_(controllers), lines_(world.robots.size()), rows_(world.robots.size()) {}

    /// A robot as it is between two steps. Only reads: no user code runs, and nothing is drawn from a random stream.
    Inspection inspect(std::uint32_t robot);

    // Filled during the run.
    PrintedLines& lines() { return lines_; }
    RecordedRows& rows() { return rows_; }

private:
    std::vector<Neighbour> neighbours_of(std::uint32_t robot);

    World const& world_;
    Controllers const& controllers_;
    Visibility visibility_;
    PrintedLines lines_;
    RecordedRows rows_;
};

}  // namespace pogosim
