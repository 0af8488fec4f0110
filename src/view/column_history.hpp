// The recorded columns over time, for the plot: of each robot, and of the swarm.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/inspection.hpp"

namespace pogosim {

/// One column over time: what the plot shows. Shape of all: as many as there are times.
struct ColumnSeries {
    std::vector<float> mean;  // of all robots that have a value; NaN: none has
    std::vector<float> low;   // 10th percentile
    std::vector<float> high;  // 90th percentile
};

class ColumnHistory {
public:
    static constexpr std::size_t kMostTimes = 4096;
    static constexpr std::size_t kMostValues = std::size_t{1} << 25U;  // of all columns, robots and times: 128 MB

    ColumnHistory(std::size_t column_count, std::size_t robot_count);

    /// Times come in order. When there are too many to keep, every second one goes, and from then on every second one
    /// is left out.
    void add(RecordedValues const& recorded);

    std::vector<double> const& times_s() const { return times_s_; }
    ColumnSeries const& swarm(std::size_t column) const { return swarm_[column]; }

    /// Shape: one per time; NaN: it has no value.
    std::vector<float> robot(std::size_t column, std::uint32_t robot) const;

private:
    void thin_out();

    std::size_t column_count_;
    std::size_t robot_count_;
    std::size_t stride_ = 1;  // one of so many times is kept
    std::size_t seen_ = 0;
    std::vector<double> times_s_;
    std::vector<ColumnSeries> swarm_;         // by column
    std::vector<std::vector<float>> values_;  // by column: time by time, robot by robot
};

}  // namespace pogosim
