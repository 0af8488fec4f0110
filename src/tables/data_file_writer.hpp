// Writes the data file: what is behind DataFile (record/data_file.hpp), whose functions these are.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "base/locked_file.hpp"
#include "record/data_file.hpp"
#include "world/data_table.hpp"

namespace pogosim {

class DataFileWriter {
public:
    static LockedFile reserve(std::string const& path);
    DataFileWriter(DataFileOptions const& options, LockedFile file);
    ~DataFileWriter();

    DataFileWriter(DataFileWriter const&) = delete;
    DataFileWriter& operator=(DataFileWriter const&) = delete;

    void append(std::span<ObjectRow const> rows, std::span<CellValue const> user);
    void save_if_due();
    void save();
    void add_metadata(std::string const& key, std::string const& value);
    void close();
    std::int64_t row_count() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pogosim
