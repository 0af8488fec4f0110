// Recorded values of the robots, for plots and the inspector.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "record/data_file.hpp"
#include "render/inspection.hpp"
#include "world/data_table.hpp"

namespace pogosim {

/// Gets the rows that go to the data file from the recorder: those of objects that run user code.
class RecordedRows {
public:
    explicit RecordedRows(std::size_t robot_count) : last_(robot_count) {}

    /// Before the first row: the user's columns, and which columns the file has, as in DataFileOptions.
    void open(std::vector<ColumnSpec> const& user_columns, std::optional<std::vector<std::string>> const& fields);

    // For each recorded time: begin, one call per row, end. Rows of a robot's subparts do not count.
    void begin(double time_s);
    void add(std::uint32_t robot, ObjectRow const& row, std::span<CellValue const> user);
    void end();

    /// Names of the columns that hold numbers, as in RecordedValues: pogobot_ticks, x, y, angle and the user's, in the
    /// order of the file. Empty before the first row.
    std::vector<std::string> const& columns() const { return columns_; }

    /// Values recorded since the last call. Booleans are 0 or 1.
    std::vector<RecordedValues> take() { return std::exchange(moments_, {}); }

    /// The last row of a robot as text, by column, and its time; empty when it has none.
    std::pair<double, std::vector<std::pair<std::string, std::string>>> last_row(std::uint32_t robot) const;

private:
    struct Row {
        bool exists = false;
        ObjectRow built_in;
        std::vector<CellValue> user;
    };

    std::vector<ColumnSpec> user_columns_;
    std::vector<bool> user_is_kept_;          // by user column: it is in the file
    std::vector<std::size_t> built_in_kept_;  // indices into a table of the built-in columns
    std::vector<std::string> columns_;
    std::vector<Row> last_;  // by robot
    RecordedValues present_;
    std::vector<RecordedValues> moments_;  // those that have not been taken
};

}  // namespace pogosim
