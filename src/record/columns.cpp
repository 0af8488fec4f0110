#include "record/columns.hpp"

#include <arrow/api.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "base/utf8.hpp"
#include "record/half.hpp"

namespace pogosim {

using arrow::ArrayBuilder;
using arrow::Status;
using MakeType = std::shared_ptr<arrow::DataType> const& (*)();

struct BuiltInColumn {
    char const* name;
    MakeType type;
    Status (*append)(ArrayBuilder& builder, ObjectRow const& row);
    bool DataFileOptions::*enabled;  // nullptr: always there
};

struct UserColumnType {
    ColumnType type;
    MakeType make;
    Status (*append)(ArrayBuilder& builder, CellValue const& cell);  // not null
};

namespace {

template <class Builder, auto Member>
Status append_member(ArrayBuilder& builder, ObjectRow const& row) {
    return static_cast<Builder&>(builder).Append(row.*Member);
}

Status append_ticks(ArrayBuilder& builder, ObjectRow const& row) {
    auto& ticks = static_cast<arrow::Int64Builder&>(builder);
    return row.ticks ? ticks.Append(*row.ticks) : ticks.AppendNull();
}

constexpr std::array<BuiltInColumn, 9> kBuiltInColumns{{
    {"time", arrow::float32, append_member<arrow::FloatBuilder, &ObjectRow::time_s>, nullptr},
    {"robot_category", arrow::utf8, append_member<arrow::StringBuilder, &ObjectRow::category>, nullptr},
    {"robot_id", arrow::int32, append_member<arrow::Int32Builder, &ObjectRow::id>, nullptr},
    {"pogobot_ticks", arrow::int64, append_ticks, nullptr},
    {"x", arrow::float32, append_member<arrow::FloatBuilder, &ObjectRow::x_mm>, nullptr},
    {"y", arrow::float32, append_member<arrow::FloatBuilder, &ObjectRow::y_mm>, nullptr},
    {"angle", arrow::float32, append_member<arrow::FloatBuilder, &ObjectRow::angle_rad>, nullptr},
    {"subpart_id", arrow::int16, append_member<arrow::Int16Builder, &ObjectRow::subpart>,
     &DataFileOptions::subpart_column},
    {"led_rgb", arrow::int32, append_member<arrow::Int32Builder, &ObjectRow::led_rgb>, &DataFileOptions::led_column},
}};

template <class Builder, class Value>
Status append_cell(ArrayBuilder& builder, CellValue const& cell) {
    using Stored = typename Builder::value_type;
    return static_cast<Builder&>(builder).Append(static_cast<Stored>(std::get<Value>(cell)));
}

Status append_half(ArrayBuilder& builder, CellValue const& cell) {
    return static_cast<arrow::HalfFloatBuilder&>(builder).Append(to_half(std::get<double>(cell)));
}

Status append_bool(ArrayBuilder& builder, CellValue const& cell) {
    return static_cast<arrow::BooleanBuilder&>(builder).Append(std::get<bool>(cell));
}

Status append_text(ArrayBuilder& builder, CellValue const& cell) {
    auto& texts = static_cast<arrow::StringBuilder&>(builder);
    auto const& text = std::get<std::string>(cell);
    return well_formed_prefix(text) == text.size() ? texts.Append(text) : texts.Append(replace_malformed(text));
}

constexpr std::array<UserColumnType, 9> kUserColumnTypes{{
    {ColumnType::int8, arrow::int8, append_cell<arrow::Int8Builder, std::int64_t>},
    {ColumnType::int16, arrow::int16, append_cell<arrow::Int16Builder, std::int64_t>},
    {ColumnType::int32, arrow::int32, append_cell<arrow::Int32Builder, std::int64_t>},
    {ColumnType::int64, arrow::int64, append_cell<arrow::Int64Builder, std::int64_t>},
    {ColumnType::float64, arrow::float64, append_cell<arrow::DoubleBuilder, double>},
    {ColumnType::text, arrow::utf8, append_text},
    {ColumnType::boolean, arrow::boolean, append_bool},
    {ColumnType::float16, arrow::float16, append_half},
    {ColumnType::float32, arrow::float32, append_cell<arrow::FloatBuilder, double>},
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

/// Names of all columns in their order. Throws ConfigError if one is empty or repeated.
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
        auto const twin = std::find(names.begin(), names.end(), name);
        if (twin != names.end()) {
            bool const built_in = std::distance(names.begin(), twin) < std::ssize(built_ins);
            throw ConfigError("the user program adds the data column '" + name + "' (data_add_column_*), but " +
                              (built_in ? "the simulator has a column of that name" : "it was added before") +
                              ": choose another name");
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

Columns::Columns(DataFileOptions const& options) : user_column_count_(options.user_columns.size()) {
    auto const available = enabled_built_ins(options);
    auto const kept = kept_names(checked_names(available, options.user_columns), options.fields);
    auto const is_kept = [&kept](std::string_view name) {
        return std::find(kept.begin(), kept.end(), name) != kept.end();
    };
    auto const new_cells = [this](std::string const& name, std::shared_ptr<arrow::DataType> const& type) {
        fields_.push_back(arrow::field(replace_malformed(name), type));
        return arrow::MakeBuilder(type).ValueOrDie();  // can fail for unknown types only
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

Status Columns::append(ObjectRow const& row, std::span<CellValue const> user) {
    assert(user.size() == user_column_count_);
    for (auto& [column, cells] : built_ins_) {
        ARROW_RETURN_NOT_OK(column->append(*cells, row));
    }
    for (auto& [type, index, cells] : users_) {
        bool const null = std::holds_alternative<std::monostate>(user[index]);
        ARROW_RETURN_NOT_OK(null ? cells->AppendNull() : type->append(*cells, user[index]));
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
    return arrays;
}

}  // namespace pogosim
