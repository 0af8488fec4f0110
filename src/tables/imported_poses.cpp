#include "tables/imported_poses.hpp"

#include <arrow/api.h>
#include <arrow/io/api.h>
#include <arrow/ipc/api.h>
#include <arrow/util/key_value_metadata.h>
#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <system_error>

#include "base/error.hpp"

namespace pogosim {

namespace {

[[noreturn]] void fail(std::filesystem::path const& path, std::string const& reason) {
    throw ConfigError(fmt::format("formation_filename: cannot read poses from '{}': {}", path.string(), reason));
}

/// An error of the system or the library, in our own words.
template <class Value>
Value value_or_fail(std::filesystem::path const& path, arrow::Result<Value> result) {
    if (!result.ok()) {
        fail(path, result.status().IsOutOfMemory() ? "there is not enough memory for its rows"
                                                   : "it is not a complete Feather file (version 2, Arrow IPC)");
    }
    return std::move(result).ValueUnsafe();
}

std::shared_ptr<arrow::io::ReadableFile> open_file(std::filesystem::path const& path) {
    // The library's own messages contain more than the system's reason.
    int const descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        fail(path, std::generic_category().message(errno));
    }
    return value_or_fail(path, arrow::io::ReadableFile::Open(descriptor));
}

/// The column of this name, or nullptr.
std::shared_ptr<arrow::Array> find_column(std::filesystem::path const& path, arrow::RecordBatch const& batch,
                                          std::string const& name) {
    if (batch.schema()->GetAllFieldIndices(name).size() > 1) {
        fail(path, fmt::format("it has several columns '{}'; rename or remove all but one", name));
    }
    return batch.GetColumnByName(name);
}

/// The numbers of a column; NaN where it is null.
std::vector<double> numbers_of(std::filesystem::path const& path, arrow::Array const& column, char const* name) {
    std::vector<double> numbers;
    for (std::int64_t i = 0; i < column.length(); ++i) {
        auto const scalar = value_or_fail(path, column.GetScalar(i));
        if (!scalar->is_valid) {
            numbers.push_back(std::numeric_limits<double>::quiet_NaN());
            continue;
        }
        auto const number = scalar->CastTo(arrow::float64());
        if (!number.ok()) {
            fail(path, fmt::format("column '{}' holds {}, expected numbers", name, column.type()->ToString()));
        }
        numbers.push_back(static_cast<arrow::DoubleScalar const&>(**number).value);
    }
    return numbers;
}

/// The categories of the rows, in a data file of a run; empty in other files.
std::vector<std::shared_ptr<std::string const>> categories_of(std::filesystem::path const& path,
                                                              arrow::RecordBatch const& batch, SharedNames& names) {
    auto const column = batch.GetColumnByName("robot_category");
    std::vector<std::shared_ptr<std::string const>> categories;
    if (column && arrow::is_base_binary_like(column->type_id())) {
        for (std::int64_t i = 0; i < column->length(); ++i) {
            auto const cell = value_or_fail(path, column->GetScalar(i));
            categories.push_back(cell->is_valid ? names.shared(cell->ToString()) : nullptr);
        }
    }
    return categories;
}

void append_poses(std::filesystem::path const& path, arrow::RecordBatch const& batch, ImportedPoses& poses,
                  SharedNames& names) {
    auto const x = find_column(path, batch, "x");
    auto const y = find_column(path, batch, "y");
    if (!x || !y) {
        fail(path, "it has no columns 'x' and 'y'");
    }
    auto const xs = numbers_of(path, *x, "x");
    auto const ys = numbers_of(path, *y, "y");
    auto const metadata = batch.schema()->metadata();
    HeadingColumn const heading =
        heading_column(batch.schema()->field_names(), metadata && metadata->Contains("program_version"));
    poses.remark = heading.remark;
    auto const angle = heading.name.empty() ? nullptr : find_column(path, batch, std::string(heading.name));
    auto const angles = angle ? numbers_of(path, *angle, "angle") : std::vector<double>();
    auto const time = find_column(path, batch, "time");
    auto const times = time ? numbers_of(path, *time, "time") : std::vector<double>();
    auto const categories = categories_of(path, batch, names);
    auto const part = batch.GetColumnByName("subpart_id");
    auto const parts = part ? numbers_of(path, *part, "subpart_id") : std::vector<double>();
    for (std::size_t i = 0; i < xs.size(); ++i) {
        ImportedPose pose;
        pose.x = xs[i];
        pose.y = ys[i];
        pose.row = poses.rows.size();
        if (!angles.empty()) {
            pose.heading_rad = angles[i];
        }
        if (!times.empty()) {
            pose.time_s = times[i];
        }
        if (!categories.empty()) {
            pose.category = categories[i];
            pose.is_part = !parts.empty() && parts[i] >= 0.0;
        }
        poses.rows.push_back(pose);
    }
}

}  // namespace

ImportedPoses read_poses(std::filesystem::path const& path) {
    auto const file = open_file(path);
    auto const reader = value_or_fail(path, arrow::ipc::RecordBatchFileReader::Open(file));
    ImportedPoses poses;
    SharedNames names;
    for (int i = 0; i < reader->num_record_batches(); ++i) {
        append_poses(path, *value_or_fail(path, reader->ReadRecordBatch(i)), poses, names);
    }
    return poses;
}

}  // namespace pogosim
