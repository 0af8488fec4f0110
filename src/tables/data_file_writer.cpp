#include "tables/data_file_writer.hpp"

#include <algorithm>
#include <utility>

#include "tables/columns.hpp"
#include "tables/table_file.hpp"
#include "tables/table_memory.hpp"

namespace pogosim {

namespace {

constexpr TableKind kKind{
    .name = "data file", .key = "data_filename", .how_to_do_without = "enable_data_logging: false"};

}  // namespace

struct DataFileWriter::Impl {
    TableMemory memory;
    Columns columns;
    TableFile table;

    Impl(DataFileOptions const& options, LockedFile file)
        : columns(options, &memory),
          table({.kind = kKind,
                 .path = options.path,
                 .flush_row_count = options.flush_row_count,
                 .metadata = options.metadata,
                 .memory = &memory},
                std::move(file), columns.fields(), [this] { return columns.take(); }) {}
};

LockedFile DataFileWriter::reserve(std::string const& path) {
    return TableFile::reserve(kKind, path);
}

DataFileWriter::DataFileWriter(DataFileOptions const& options, LockedFile file)
    : impl_(std::make_unique<Impl>(options, std::move(file))) {}

DataFileWriter::~DataFileWriter() = default;

void DataFileWriter::append(std::span<ObjectRow const> rows, std::span<CellValue const> user) {
    if (rows.empty()) {
        return;
    }
    std::size_t const width = user.size() / rows.size();
    while (!rows.empty()) {
        std::size_t const count = std::min<std::size_t>(rows.size(), impl_->table.room());
        impl_->table.count_rows(rows.front().time_s, count, status_of([&] {
                                    return impl_->columns.append(rows.first(count), user.first(count * width));
                                }));
        rows = rows.subspan(count);
        user = user.subspan(count * width);
    }
}

void DataFileWriter::save_if_due() {
    impl_->table.save_if_due();
}

void DataFileWriter::save() {
    impl_->table.save();
}

void DataFileWriter::add_metadata(std::string const& key, std::string const& value) {
    impl_->table.add_metadata(key, value);
}

void DataFileWriter::close() {
    impl_->table.close();
}

std::int64_t DataFileWriter::row_count() const {
    return impl_->table.row_count();
}

}  // namespace pogosim
