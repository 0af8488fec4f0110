// The user's columns of the data file, and the values that the program gives them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "world/data_table.hpp"

namespace pogosim {

/// Values of columns that callbacks of the whole run set, for all objects or for one: they stand in all rows from then
/// on, unless an object's callback_export_data sets its own.
class HeldValues {
public:
    /// Whether no value has been set.
    bool empty() const { return columns_.empty(); }

    /// Sets the value for all objects, also for those that had one of their own.
    void set_for_all(std::size_t column, CellValue const& value);

    /// `object`: index into World::objects, of so many.
    void set_for(std::size_t column, std::uint32_t object, std::size_t object_count, CellValue const& value);

    /// Puts the values of an object into its row. Cells without a value stay as they are.
    void fill(std::uint32_t object, std::span<CellValue> row) const;

    /// See state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.columns_);
    }

private:
    /// A monostate: no value.
    struct Column {
        CellValue of_all;
        std::vector<CellValue> of_object;  // empty, or one for each object

        template <class Self, class State>
        static void visit_state(Self& self, State& state) {
            state(self.of_all, self.of_object);
        }
    };

    Column& at(std::size_t column);

    std::vector<Column> columns_;
};

/// The user's columns and the row being filled.
struct DataExport {
    std::vector<ColumnSpec> columns;
    std::vector<bool> was_set;     // by column, in any row
    std::int64_t filled_rows = 0;  // exported rows for which the program's callback ran
    DataRow row;
    HeldValues held;              // of columns that the whole run sets
    bool is_declared = false;     // callback_create_data_schema has run or is running
    bool awaits_step = false;     // only callback_global_step can set values
    bool declaring = false;       // inside callback_create_data_schema
    bool filling = false;         // inside callback_export_data
    std::size_t next_column = 0;  // where the search for the next value's column starts

    /// From now on the column has this value in the rows of all objects, or of one of `object_count`. Throws
    /// ConfigError for an unknown column and for a value that the type of the column does not have.
    void hold(std::size_t object_count, std::optional<std::uint32_t> object, std::string_view name, double value);
};

}  // namespace pogosim
