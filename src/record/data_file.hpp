// The data file: Apache Feather V2 (Arrow IPC, zstd), CSV or Parquet, one row per object and save time; src/tables
// writes it.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/locked_file.hpp"
#include "world/data_table.hpp"

namespace pogosim {

struct DataFileOptions {
    std::string path{};                                // parent folders are created
    std::vector<ColumnSpec> user_columns{};            // behind the built-in ones
    std::optional<std::vector<std::string>> fields{};  // allow-list of columns, built-in and user; absent: all
    bool subpart_column = false;                       // adds subpart_id
    bool led_column = false;                           // adds led_rgb
    bool tension_column = false;                       // adds tension
    std::int64_t flush_row_count = 65536;              // rows per record batch, > 0
    std::vector<std::pair<std::string, std::string>> metadata{};  // of the schema, UTF-8
};

/// The built-in part of one row.
struct ObjectRow {
    double time_s = 0.0;
    std::string_view category;
    std::int32_t id = 0;
    std::optional<std::int64_t> ticks{};  // null for objects without a program
    float x_mm = 0.0F;                    // NaN for walls
    float y_mm = 0.0F;
    float angle_rad = 0.0F;  // (-pi, pi]; NaN for walls and membranes
    std::int16_t subpart = -1;
    std::int32_t led_rgb = 0;  // head LED as 0xRRGGBB
    float tension_n = 0.0F;    // of its link with the largest one, see tensions_of_bodies()
};

/// Columns: time float64 (rounded to 1 ns), robot_category utf8, robot_id int32, pogobot_ticks int64, x, y, angle
/// float32, [subpart_id int16], [led_rgb int32], [tension float32], then the user's. Every failure to write throws
/// OutputError naming the path and the system's reason; nothing is lost silently.
///
/// In a child after fork(), it writes nothing.
class DataFile {
public:
    /// Opens and locks the file and creates its folder, so that an unwritable path, or another run that writes the same
    /// file, is detected before the run. The contents remain until a DataFile is created. Throws OutputError.
    static LockedFile reserve(std::string const& path);

    explicit DataFile(DataFileOptions const& options) : DataFile(options, reserve(options.path)) {}

    /// Empties the file of `options.path` and writes its head.
    DataFile(DataFileOptions const& options, LockedFile file);

    /// Closes the file if it is still open, writing as much as possible; errors are logged.
    ~DataFile();

    DataFile(DataFile const&) = delete;
    DataFile& operator=(DataFile const&) = delete;

    /// Adds rows of one time. `user` holds, row after row, one value per user column, in their order (monostate: null).
    void append(std::span<ObjectRow const> rows, std::span<CellValue const> user);
    void append(ObjectRow const& row, std::span<CellValue const> user) { append(std::span(&row, 1), user); }
    void append(ObjectRow const& row, std::initializer_list<CellValue> user) {
        append(row, std::span(user.begin(), user.size()));
    }

    /// Writes new rows to the unfinished file when that is due: a few seconds of wall-clock time after the last time,
    /// so that at most 1 % of the run is spent on it unless the disk is slow. Call it often.
    void save_if_due();

    /// Writes new rows to the unfinished file now.
    void save();

    /// Adds an entry to the metadata of the complete file; the unfinished one does not get it. Where the complete one
    /// has been begun, it is copied once more at the end.
    void add_metadata(std::string const& key, std::string const& value);

    /// Completes the file, and checks that all of it reached the disk. Further calls do nothing.
    void close();

    /// Rows appended so far.
    std::int64_t row_count() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pogosim
