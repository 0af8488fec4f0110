#include "tables/columns.hpp"

#include <arrow/api.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "base/error.hpp"
#include "base/half.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "base/rounded_time.hpp"
#include "base/utf8.hpp"

namespace pogosim {

using arrow::ArrayBuilder;
using arrow::Status;
using MakeType = std::shared_ptr<arrow::DataType> const& (*)();

/// The cells of one user column: every `width`-th value, from the first on.
struct UserCells {
    std::span<CellValue const> cells;
    std::size_t width;

    std::size_t size() const { return (cells.size() + width - 1) / width; }
    CellValue const& operator[](std::size_t row) const { return cells[row * width]; }
};

struct BuiltInColumn {
    char const* name;
    MakeType type;
    Status (*append)(ArrayBuilder& builder, std::span<ObjectRow const> rows);
    bool DataFileOptions::*enabled;  // nullptr: always there
};

struct UserColumnType {
    ColumnType type;
    MakeType make;
    Status (*append)(ArrayBuilder& builder, UserCells const& cells);
};

namespace {

/// Cells that are handed to a builder together: their bits of validity are then set at once.
constexpr std::size_t kRowsAtOnce = 256;

template <class Builder, auto Member>
Status append_member(ArrayBuilder& builder, std::span<ObjectRow const> rows) {
    std::array<typename Builder::value_type, kRowsAtOnce> values;
    for (; !rows.empty(); rows = rows.subspan(std::min(rows.size(), kRowsAtOnce))) {
        auto const some = rows.first(std::min(rows.size(), kRowsAtOnce));
        std::transform(some.begin(), some.end(), values.begin(), [](ObjectRow const& row) { return row.*Member; });
        ARROW_RETURN_NOT_OK(static_cast<Builder&>(builder).AppendValues(values.data(), std::ssize(some)));
    }
    return Status::OK();
}

Status append_category(ArrayBuilder& builder, std::span<ObjectRow const> rows) {
    auto& names = static_cast<arrow::StringBuilder&>(builder);
    std::size_t bytes = 0;
    for (ObjectRow const& row : rows) {
        bytes += row.category.size();
    }
    ARROW_RETURN_NOT_OK(names.Reserve(std::ssize(rows)));
    ARROW_RETURN_NOT_OK(names.ReserveData(static_cast<std::int64_t>(bytes)));
    for (ObjectRow const& row : rows) {
        names.UnsafeAppend(row.category);
    }
    return Status::OK();
}

Status append_ticks(ArrayBuilder& builder, std::span<ObjectRow const> rows) {
    auto& ticks = static_cast<arrow::Int64Builder&>(builder);
    ARROW_RETURN_NOT_OK(ticks.Reserve(std::ssize(rows)));
    for (ObjectRow const& row : rows) {
        if (row.ticks) {
            ticks.UnsafeAppend(*row.ticks);
        } else {
            ticks.UnsafeAppendNull();
        }
    }
    return Status::OK();
}

Status append_time(ArrayBuilder& builder, std::span<ObjectRow const> rows) {
    auto& times = static_cast<arrow::DoubleBuilder&>(builder);
    ARROW_RETURN_NOT_OK(times.Reserve(std::ssize(rows)));
    double const time_s = rounded_to_ns(rows.front().time_s);  // of all
    for (std::size_t row = 0; row < rows.size(); ++row) {
        times.UnsafeAppend(time_s);
    }
    return Status::OK();
}

constexpr std::array<BuiltInColumn, 10> kBuiltInColumns{{
    {"time", arrow::float64, append_time, nullptr},
    {"robot_category", arrow::utf8, append_category, nullptr},
    {"robot_id", arrow::int32, append_member<arrow::Int32Builder, &ObjectRow::id>, nullptr},
    {"pogobot_ticks", arrow::int64, append_ticks, nullptr},
    {"x", arrow::float32, append_member<arrow::FloatBuilder, &ObjectRow::x_mm>, nullptr},
    {"y", arrow::float32, append_member<arrow::FloatBuilder, &ObjectRow::y_mm>, nullptr},
    {"angle", arrow::float32, append_member<arrow::FloatBuilder, &ObjectRow::angle_rad>, nullptr},
    {"subpart_id", arrow::int16, append_member<arrow::Int16Builder, &ObjectRow::subpart>,
     &DataFileOptions::subpart_column},
    {"led_rgb", arrow::int32, append_member<arrow::Int32Builder, &ObjectRow::led_rgb>, &DataFileOptions::led_column},
    {"tension", arrow::float32, append_member<arrow::FloatBuilder, &ObjectRow::tension_n>,
     &DataFileOptions::tension_column},
}};

bool is_null(CellValue const& cell) {
    return std::holds_alternative<std::monostate>(cell);
}

template <class Value, class Stored>
Stored stored(CellValue const& cell) {
    return static_cast<Stored>(std::get<Value>(cell));
}

std::uint16_t stored_half(CellValue const& cell) {
    return to_half(std::get<double>(cell));
}

template <class Builder, auto Stored>
Status append_numbers(ArrayBuilder& builder, UserCells const& cells) {
    auto& numbers = static_cast<Builder&>(builder);
    ARROW_RETURN_NOT_OK(numbers.Reserve(static_cast<std::int64_t>(cells.size())));
    for (std::size_t row = 0; row < cells.size(); ++row) {
        if (is_null(cells[row])) {
            numbers.UnsafeAppendNull();
        } else {
            numbers.UnsafeAppend(Stored(cells[row]));
        }
    }
    return Status::OK();
}

Status append_texts(ArrayBuilder& builder, UserCells const& cells) {
    auto& texts = static_cast<arrow::StringBuilder&>(builder);
    for (std::size_t row = 0; row < cells.size(); ++row) {
        if (is_null(cells[row])) {
            ARROW_RETURN_NOT_OK(texts.AppendNull());
            continue;
        }
        auto const& text = std::get<std::string>(cells[row]);
        bool const is_well_formed = well_formed_prefix(text) == text.size();
        ARROW_RETURN_NOT_OK(is_well_formed ? texts.Append(text) : texts.Append(replace_malformed(text)));
    }
    return Status::OK();
}

template <class Builder, class Value>
constexpr auto kAppend = append_numbers<Builder, stored<Value, typename Builder::value_type>>;

constexpr std::array<UserColumnType, 9> kUserColumnTypes{{
    {ColumnType::int8, arrow::int8, kAppend<arrow::Int8Builder, std::int64_t>},
    {ColumnType::int16, arrow::int16, kAppend<arrow::Int16Builder, std::int64_t>},
    {ColumnType::int32, arrow::int32, kAppend<arrow::Int32Builder, std::int64_t>},
    {ColumnType::int64, arrow::int64, kAppend<arrow::Int64Builder, std::int64_t>},
    {ColumnType::float64, arrow::float64, kAppend<arrow::DoubleBuilder, double>},
    {ColumnType::text, arrow::utf8, append_texts},
    {ColumnType::boolean, arrow::boolean, append_numbers<arrow::BooleanBuilder, stored<bool, bool>>},
    {ColumnType::float16, arrow::float16, append_numbers<arrow::HalfFloatBuilder, stored_half>},
    {ColumnType::float32, arrow::float32, kAppend<arrow::FloatBuilder, double>},
}};

UserColumnType const& user_column_type(ColumnType type) {
    auto const* const found = std::find_if(kUserColumnTypes.begin(), kUserColumnTypes.end(),
                                           [type](UserColumnType const& known) { return known.type == type; });
    assert(found != kUserColumnTypes.end());
    return *found;
}

// ---- which columns --------------------------------------------------------------------------------------------------

std::vector<BuiltInColumn const*> enabled_built_ins(DataFileOptions const& options) {
    std::vector<BuiltInColumn const*> enabled;
    for (auto const& column : kBuiltInColumns) {
        if (column.enabled == nullptr || options.*column.enabled) {
            enabled.push_back(&column);
        }
    }
    return enabled;
}

/// Columns by which the tools tell runs apart, see docs/data_file.md and python/pogosim/run_columns.py.
constexpr std::array<std::string_view, 3> kColumnsOfRuns{"run", "seed", "arena_file"};
constexpr std::array<std::string_view, 2> kKeysOfRuns{"objects.", "parameters."};

/// What tools would take a user's column of this name for; empty: they have no other meaning for it.
std::string_view meaning_for_tools(std::string_view name) {
    bool const tells_runs_apart =
        std::ranges::find(kColumnsOfRuns, name) != kColumnsOfRuns.end() ||
        std::ranges::any_of(kKeysOfRuns, [name](std::string_view key) { return name.starts_with(key); });
    if (tells_runs_apart) {
        return "tools tell runs apart by columns of that name, so they will not join this file with others";
    }
    return name == "led_rgb" ? "tools take a column of that name for the colour of the head LED (0xRRGGBB)" : "";
}

/// True if tools would mistake the rows for others. In a file without the simulator's own colours, a column of colours
/// does no harm.
bool is_reserved(std::string_view name, std::span<BuiltInColumn const* const> built_ins) {
    return name == "subpart_id" ||
           std::ranges::any_of(built_ins, [name](BuiltInColumn const* column) { return column->name == name; });
}

/// Names of all columns in their order. Throws ConfigError if one of the user's is empty, repeated or reserved. Warns
/// about names that mean something to tools.
std::vector<std::string> checked_names(std::span<BuiltInColumn const* const> built_ins,
                                       std::span<ColumnSpec const> user_columns) {
    std::vector<std::string> names;
    for (auto const* column : built_ins) {
        names.emplace_back(column->name);
    }
    for (auto const& [name, type] : user_columns) {
        if (name.empty()) {
            throw ConfigError("the user program adds a data column without a name (data_add_column_*): name it");
        }
        bool const is_built_in = is_reserved(name, built_ins);
        if (is_built_in || std::ranges::find(names, name) != names.end()) {
            throw ConfigError("the user program adds the data column '" + name + "' (data_add_column_*), but " +
                              (is_built_in ? "the simulator has a column of that name" : "it was added before") +
                              ": choose another name");
        }
        if (auto const meaning = meaning_for_tools(name); !meaning.empty()) {
            log().warn("the user program adds the data column '{}' (data_add_column_*), but {}: choose another name",
                       replace_malformed(name), meaning);
        }
        names.push_back(name);
    }
    return names;
}

std::string joined(std::span<std::string const> names) {
    std::string text;
    for (auto const& name : names) {
        text += (text.empty() ? "" : ", ") + name;
    }
    return text;
}

/// The columns of `names` in the allow-list. Warns about entries that are unknown columns; throws ConfigError if no
/// column is left.
std::vector<std::string> kept_names(std::vector<std::string> names,
                                    std::optional<std::vector<std::string>> const& fields) {
    if (!fields) {
        return names;
    }
    for (auto const& field : *fields) {
        if (std::find(names.begin(), names.end(), field) == names.end()) {
            auto const nearest = nearest_name(field, names);
            log().warn("data_logger_fields: there is no column '{}'{}; the columns are: {}", field,
                       nearest.empty() ? "" : ", did you mean '" + nearest + "'?", joined(names));
        }
    }
    auto const all = joined(names);
    std::erase_if(names, [&fields](std::string const& name) {
        return std::find(fields->begin(), fields->end(), name) == fields->end();
    });
    if (names.empty()) {
        throw ConfigError("data_logger_fields: no column of the data file is selected; choose from: " + all +
                          ", omit the key to record all, or set enable_data_logging to false");
    }
    return names;
}

}  // namespace

Columns::Columns(DataFileOptions const& options, arrow::MemoryPool* memory)
    : user_column_count_(options.user_columns.size()) {
    auto const available = enabled_built_ins(options);
    auto const kept = kept_names(checked_names(available, options.user_columns), options.fields);
    auto const is_kept = [&kept](std::string_view name) {
        return std::find(kept.begin(), kept.end(), name) != kept.end();
    };
    auto const new_cells = [this, memory](std::string const& name, std::shared_ptr<arrow::DataType> const& type) {
        fields_.push_back(arrow::field(replace_malformed(name), type));
        return arrow::MakeBuilder(type, memory).ValueOrDie();  // can fail for unknown types only
    };

    for (auto const* column : available) {
        if (is_kept(column->name)) {
            built_ins_.push_back({column, new_cells(column->name, column->type())});
        }
    }
    for (std::size_t i = 0; i < options.user_columns.size(); ++i) {
        auto const& [name, type] = options.user_columns[i];
        if (is_kept(name)) {
            auto const& stored = user_column_type(type);
            users_.push_back({&stored, i, new_cells(name, stored.make())});
        }
    }
}

Status Columns::append(std::span<ObjectRow const> rows, std::span<CellValue const> user) {
    assert(user.size() == rows.size() * user_column_count_);
    if (auto const rows_ahead = std::exchange(taken_rows_, 0); rows_ahead > 0) {
        ARROW_RETURN_NOT_OK(reserve(rows_ahead));
    }
    for (auto& [column, cells] : built_ins_) {
        ARROW_RETURN_NOT_OK(column->append(*cells, rows));
    }
    for (auto& [type, index, cells] : users_) {
        ARROW_RETURN_NOT_OK(type->append(*cells, {.cells = user.subspan(index), .width = user_column_count_}));
    }
    return Status::OK();
}

/// Memory for so many rows, which otherwise grows by halves that are copied.
Status Columns::reserve(std::int64_t row_count) {
    for (auto& column : built_ins_) {
        ARROW_RETURN_NOT_OK(column.cells->Reserve(row_count));
    }
    for (auto& column : users_) {
        ARROW_RETURN_NOT_OK(column.cells->Reserve(row_count));
    }
    return Status::OK();
}

arrow::Result<arrow::ArrayVector> Columns::take() {
    arrow::ArrayVector arrays;
    for (auto& column : built_ins_) {
        ARROW_RETURN_NOT_OK(column.cells->Finish(&arrays.emplace_back()));
    }
    for (auto& column : users_) {
        ARROW_RETURN_NOT_OK(column.cells->Finish(&arrays.emplace_back()));
    }
    taken_rows_ = arrays.front()->length();
    return arrays;
}

}  // namespace pogosim
