// When rows of the data file and of the message log are due, and their contents.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "brain/brain.hpp"
#include "config/scenario.hpp"
#include "process/crash_handler.hpp"
#include "record/data_file.hpp"
#include "robot/controllers.hpp"
#include "sim/due_times.hpp"
#include "sim/link_changes.hpp"
#include "sim/message_recorder.hpp"
#include "sim/recorded_rows.hpp"
#include "sim/saved_columns.hpp"
#include "world/world.hpp"

namespace pogosim {

class Recorder {
public:
    /// Locks the files, so that no other run writes them. All references outlive this. `data` is what user code
    /// declares and exports. Throws OutputError, and ConfigError for a name whose format is unknown.
    Recorder(Scenario const& scenario, World const& world, Controllers& controllers, Brains const& brains,
             DataExport& data, std::uint32_t seed);

    /// Before open(): the data file goes on behind this number of rows of earlier parts, as its metadata say.
    void go_on_behind(std::int64_t rows) { rows_before_ = rows; }

    /// Lets the program declare its columns and opens the files that are wanted. Throws OutputError.
    std::optional<UserFailure> open();

    /// Makes empty files for a program that failed before open(). Does nothing when they are open.
    void open_without_rows();

    /// Takes the messages of the next step; null: there is no message log.
    DeliveryLog* deliveries() { return messages_ ? &messages_->deliveries() : nullptr; }

    /// Writes what became of the last step's messages, and the current rows if a multiple of the save period has been
    /// reached. Throws OutputError.
    std::optional<UserFailure> record_if_due();

    /// Saves rows to disk when that is due, so that they outlive the process. Call it at every step. Throws
    /// OutputError.
    void save_if_due();

    /// Saves rows now. Throws OutputError.
    void save_now();

    /// From now on, `rows` gets what is recorded of robots; null: none. `rows` outlives this.
    void show(RecordedRows* rows);

    /// From open() on, `columns` gets what robots give at each save. `columns` outlives this.
    void keep(SavedColumns* columns) { kept_ = columns; }

    /// Adds an entry to the metadata of the complete files.
    void add_metadata(std::string const& key, std::string const& value);

    /// Completes the files, the data file first. Throws OutputError.
    void close();

    /// Lets go of the complete file, so that another run may write it.
    void release() {
        data_file_.reset();
        messages_.reset();
    }

    /// What the rows and messages of later steps depend on, see state_bytes.hpp.
    void append_state(StateWriter& state) const;

    /// Goes on in this world behind the rows that a run had before. Throws ForeignState.
    void take_state(StateReader& state);

    /// What the metadata of the files say of the run.
    std::vector<std::pair<std::string, std::string>> metadata() const;

    /// Rows of the data file so far; none if there is no data file.
    std::optional<std::int64_t> row_count() const;

    /// With those of earlier parts.
    std::int64_t all_rows() const { return rows_before_.value_or(0) + row_count().value_or(0); }

    /// The end of a message about a run that ended early: where its data are. Empty before close() has completed the
    /// file.
    std::string note() const;

private:
    OutputConfig const& output() const { return scenario_.output; }
    void make_data_file();
    void open_message_log();
    /// The rows of all objects, also of those before the one whose code fails.
    std::optional<UserFailure> record_rows();
    /// Runs all user code of a save. After a failure, the table has the rows until then.
    std::optional<UserFailure> fill_table();
    void add_to_table(std::uint32_t object);
    void write_table();
    void show_table();
    std::optional<std::int64_t> ticks_of(Object const& object) const;
    /// Rows of its bodies, each like the object's own `row` at another place.
    void record_subparts(Object const& object, ObjectRow row);

    Scenario const& scenario_;
    World const& world_;
    Controllers& controllers_;
    Brains const& brains_;
    DataExport& export_;
    std::uint32_t seed_;
    std::vector<bool> category_is_recorded_;
    LockedFile reserved_;  // until there is a data file
    std::unique_ptr<DataFile> data_file_;
    std::unique_ptr<MessageRecorder> messages_;  // null: there is no message log
    bool is_opened_ = false;                     // by open(): rows come into it
    bool is_complete_ = false;
    RecordedRows* shown_ = nullptr;  // of the inspector; null: rows are not shown
    SavedColumns* kept_ = nullptr;   // null: not kept
    DataTable table_;                // of the present save
    LinkRecord links_;
    std::vector<ObjectRow> built_in_;     // of its rows
    std::vector<CellValue> empty_cells_;  // user columns of subparts
    RowTimes row_times_;
    double row_time_s_ = 0.0;                    // that of the last rows
    std::optional<std::int64_t> rows_before_{};  // absent: this is the first part
};

}  // namespace pogosim
