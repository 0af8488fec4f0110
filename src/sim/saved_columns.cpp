#include "sim/saved_columns.hpp"

#include <algorithm>
#include <variant>

#include "base/utf8.hpp"
#include "world/data_table.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kNoRow = std::numeric_limits<std::size_t>::max();

/// A text cannot contain a zero byte, since it comes from C (data_set_value_string).
void add_text(std::string& texts, CellValue const& cell) {
    if (auto const* const given = std::get_if<std::string>(&cell)) {
        texts += well_formed_prefix(*given) == given->size() ? *given : replace_malformed(*given);
    }
    texts += '\0';
}

}  // namespace

void SavedColumns::open(std::span<ColumnSpec const> columns, std::size_t robot_count) {
    columns_.clear();
    for (ColumnSpec const& spec : columns) {
        SavedColumn& column = columns_.emplace_back();
        column.name = replace_malformed(spec.name);
        column.type = spec.type;
        column.values.resize(robot_count * row_of(spec.type).bytes);
        column.is_absent.resize(robot_count, 1);
    }
    row_of_robot_.resize(robot_count);
}

void SavedColumns::save(World const& world, DataTable const& rows) {
    time_s_ = world.time_s();
    std::ranges::fill(row_of_robot_, kNoRow);
    for (std::size_t row = 0; row < rows.object.size(); ++row) {
        Object const& object = world.objects[rows.object[row]];
        if (object.robot != kNone) {
            row_of_robot_[object.robot] = row;
        }
    }
    CellValue const none;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        SavedColumn& column = columns_[i];
        ColumnTypeRow const& type = row_of(column.type);
        column.texts.clear();
        for (std::size_t robot = 0; robot < row_of_robot_.size(); ++robot) {
            std::size_t const row = row_of_robot_[robot];
            CellValue const& cell = row != kNoRow ? rows.cells_of(row)[i] : none;
            column.is_absent[robot] = std::holds_alternative<std::monostate>(cell) ? 1 : 0;
            if (column.type == ColumnType::text) {
                add_text(column.texts, cell);
            } else {
                type.write(column.values.data() + robot * type.bytes, cell);
            }
        }
    }
}

}  // namespace pogosim
