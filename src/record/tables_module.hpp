// The module that writes and reads files of tables, and links Arrow, the largest library of all: loading it takes
// longer than a short run, so it is loaded when the first of these files is opened.
//
//     DataFile, MessageLog, read_imported_feather()
//         └─► tables_module() ──► src/tables, in a library of its own
//
// Module and library are built together, so values of C++ pass between them; but each has its own copy of the room
// base, and no exception leaves the module, since some systems do not know its type elsewhere. What is one for the
// whole process is the library's: the log, the list of scratch files, the progress of writing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>

#include "base/current_log.hpp"
#include "base/locked_file.hpp"
#include "base/save_progress.hpp"
#include "geometry/formation.hpp"
#include "pogosim/version.h"
#include "record/data_file.hpp"
#include "record/message_log.hpp"
#include "world/data_table.hpp"

namespace pogosim {

/// A call of the module.
struct TablesCall {
    enum class Error { none, config, output, memory, other };

    Log* log = nullptr;         // of the caller
    Error error = Error::none;  // what it would have thrown
    std::string what{};
};

/// A table that is being written: as DataFile and MessageLog say.
class WrittenTable {
public:
    virtual void save_if_due(TablesCall& call) = 0;
    virtual void save(TablesCall& call) = 0;
    virtual void add_metadata(std::string const& key, std::string const& value, TablesCall& call) = 0;
    virtual void close(TablesCall& call) = 0;
    virtual std::int64_t row_count() const = 0;

    /// Closes it if that was not done, and frees it.
    virtual void destroy(TablesCall& call) = 0;

protected:
    ~WrittenTable() = default;
};

class WrittenDataFile : public WrittenTable {
public:
    virtual void append(std::span<ObjectRow const> rows, std::span<CellValue const> user, TablesCall& call) = 0;

protected:
    ~WrittenDataFile() = default;
};

class WrittenMessageLog : public WrittenTable {
public:
    virtual void append(MessageRow const& row, TablesCall& call) = 0;

protected:
    ~WrittenMessageLog() = default;
};

/// What the process has once.
struct TablesHost {
    void* scratch_files;
    SaveProgress* save_progress;
};

/// The functions of the module. The caller destroys what the last but one pair returns; null after an error.
struct TablesModule {
    LockedFile (*reserve_data_file)(std::string const& path, TablesCall& call);
    LockedFile (*reserve_message_log)(std::string const& path, TablesCall& call);
    WrittenDataFile* (*open_data_file)(DataFileOptions const& options, LockedFile file, TablesCall& call);
    WrittenMessageLog* (*open_message_log)(MessageLogOptions const& options, LockedFile file, TablesCall& call);
    ImportedPoses (*read_imported_feather)(std::filesystem::path const& path, TablesCall& call);
};

/// The function that the module exports.
using GetTablesModule = TablesModule const* (*)(TablesHost const& host);
inline constexpr char const* kGetTablesModuleName = "pogosim_tables_module";

/// The file, beside that of libpogosim.
#ifdef __APPLE__
inline constexpr char const* kTablesModuleFile = "libpogosim_tables-" POGOSIM_VERSION_STRING ".dylib";
#else
inline constexpr char const* kTablesModuleFile = "libpogosim_tables-" POGOSIM_VERSION_STRING ".so";
#endif

/// The module, which is loaded by the first call and stays loaded. Throws std::runtime_error with the reason if that is
/// not possible.
TablesModule const& tables_module();

/// The same for a file that is to be written, a `what` that the configuration calls `key`. Throws OutputError with its
/// path if the module cannot be loaded, OutOfMemory if memory is short.
TablesModule const& tables_module_to_write(char const* what, std::string const& path, char const* key);

/// For executables that the room `tables` is a part of, such as tests: nothing is loaded then.
void link_tables_module(GetTablesModule get_module);

/// Throws what the call would have thrown.
void throw_if_failed(TablesCall const& call);

/// Returns function(call), or throws what went wrong in it.
template <class Function>
auto call_tables(Function const& function) {
    TablesCall call{.log = &current_log()};
    if constexpr (std::is_void_v<decltype(function(call))>) {
        function(call);
        throw_if_failed(call);
    } else {
        auto result = function(call);
        throw_if_failed(call);
        return result;
    }
}

}  // namespace pogosim
