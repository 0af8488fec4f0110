// When rows of the data file are due, and their contents.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/scenario.hpp"
#include "record/data_file.hpp"
#include "robot/programs.hpp"
#include "robot/user_guard.hpp"
#include "sim/multiples.hpp"
#include "sim/recorded_rows.hpp"
#include "world/world.hpp"

namespace pogosim {

class Recorder {
public:
    /// Locks the data file, so that no other run writes it. All references outlive this. `data` is what user code
    /// declares and exports. Throws OutputError.
    Recorder(Scenario const& scenario, World const& world, Programs& programs, DataExport const& data,
             std::uint32_t seed);

    /// Lets the program declare its columns and opens the data file, if enabled. Throws OutputError.
    std::optional<UserFailure> open();

    /// For a program that failed before open(): an empty file. Does nothing when the file is open.
    void open_without_rows();

    /// Writes the current rows if a multiple of the save period has been reached. Throws OutputError.
    std::optional<UserFailure> record_if_due();

    /// Saves rows to disk when that is due, so that they outlive the process. Call it at every step. Throws
    /// OutputError.
    void save_if_due();

    /// Saves rows now. Throws OutputError.
    void save_now();

    /// From now on, `rows` gets what is recorded of robots; null: nobody does. `rows` outlives this.
    void show(RecordedRows* rows);

    /// One more entry in the metadata of the complete file.
    void add_metadata(std::string const& key, std::string const& value);

    /// Completes the file. Throws OutputError.
    void close();

    /// Lets go of the complete file, so that another run may write it.
    void release() { data_file_.reset(); }

    /// Behind a message about a run that ended early: where its data is. Empty before close() has completed the file.
    std::string note() const;

private:
    OutputConfig const& output() const { return scenario_.output; }
    void make_data_file();
    std::optional<UserFailure> record_rows();
    void record_subparts(Object const& object);

    Scenario const& scenario_;
    World const& world_;
    Programs& programs_;
    DataExport const& export_;
    std::uint32_t seed_;
    std::vector<bool> category_is_recorded_;
    LockedFile reserved_;  // until there is a data file
    std::unique_ptr<DataFile> data_file_;
    bool is_opened_ = false;  // by open(): rows come into it
    bool is_complete_ = false;
    RecordedRows* shown_ = nullptr;  // null: nobody looks
    DataRow empty_row_;              // user columns of what runs no user code
    Multiples row_times_;
};

}  // namespace pogosim
