// The metadata of a CSV file, which cannot hold any: a YAML file beside it (d.csv.yaml for d.csv), with the types of
// the columns.
#pragma once

#include <arrow/result.h>
#include <arrow/status.h>
#include <arrow/type.h>

#include <filesystem>
#include <memory>

#include "base/scratch_file.hpp"

namespace pogosim {

class MetadataBeside {
public:
    /// True if another program's file is there, which must not be overwritten.
    static bool is_taken(std::filesystem::path const& table);

    /// False if the name of the metadata, or that until they are complete, is longer than the file system allows.
    static bool has_short_name(std::filesystem::path const& table);

    /// Writes the metadata of a schema to a file of another name beside the table. `sync`: waits for the disk.
    static arrow::Result<std::unique_ptr<MetadataBeside>> write(std::filesystem::path const& table,
                                                                arrow::Schema const& schema, bool sync);

    /// Renames the file to that of a table in the same folder. Without this call, it is removed with this object.
    arrow::Status belong_to(std::filesystem::path const& table);

private:
    explicit MetadataBeside(std::filesystem::path const& path) : path_(path), scratch_(path) {}

    std::filesystem::path path_;
    ScratchFile scratch_;
};

}  // namespace pogosim
