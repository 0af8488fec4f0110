// The values that robots gave for the columns of the data file at its last save, as arrays for hosts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "world/data_table.hpp"
#include "world/world.hpp"

namespace pogosim {

/// A user column of the last save; values are by robot (index into World::robots). A robot without a value has none in
/// the file: it gave none, or has no row.
struct SavedColumn {
    std::string name;  // as in the file
    ColumnType type = ColumnType::float64;
    std::vector<std::byte> values;        // of the file's type, where there is none: NaN, 0 or false. Not of text
    std::vector<std::uint8_t> is_absent;  // 0 or 1
    std::string texts;                    // of text: UTF-8, each ended by a zero
};

/// Gets the rows of each save from the recorder. Arrays stay where they are from open() on, but for texts.
class SavedColumns {
public:
    /// Before the first save: the columns of the program, with no values.
    void open(std::span<ColumnSpec const> columns, std::size_t robot_count);

    /// The rows of each save replace the previous ones.
    void save(World const& world, DataTable const& rows);

    std::span<SavedColumn const> columns() const { return columns_; }

    /// Simulated time of the last save; NaN before the first.
    double time_s() const { return time_s_; }

private:
    std::vector<SavedColumn> columns_;
    double time_s_ = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::size_t> row_of_robot_;
};

}  // namespace pogosim
