#include "record/data_file.hpp"

#include <utility>

#include "record/tables_module.hpp"

namespace pogosim {

namespace {

TablesModule const& module_for(std::string const& path) {
    return tables_module_to_write("data file", path, "data_filename");
}

}  // namespace

struct DataFile::Impl {
    explicit Impl(WrittenDataFile* written) : table(written) {}

    WrittenDataFile* table;
};

LockedFile DataFile::reserve(std::string const& path) {
    TablesModule const& module = module_for(path);
    return call_tables([&](TablesCall& call) { return module.reserve_data_file(path, call); });
}

DataFile::DataFile(DataFileOptions const& options, LockedFile file) {
    TablesModule const& module = module_for(options.path);
    impl_ = std::make_unique<Impl>(
        call_tables([&](TablesCall& call) { return module.open_data_file(options, std::move(file), call); }));
}

DataFile::~DataFile() {
    TablesCall call{.log = &current_log()};
    impl_->table->destroy(call);
}

void DataFile::append(std::span<ObjectRow const> rows, std::span<CellValue const> user) {
    call_tables([&](TablesCall& call) { impl_->table->append(rows, user, call); });
}

void DataFile::save_if_due() {
    call_tables([&](TablesCall& call) { impl_->table->save_if_due(call); });
}

void DataFile::save() {
    call_tables([&](TablesCall& call) { impl_->table->save(call); });
}

void DataFile::add_metadata(std::string const& key, std::string const& value) {
    call_tables([&](TablesCall& call) { impl_->table->add_metadata(key, value, call); });
}

void DataFile::close() {
    call_tables([&](TablesCall& call) { impl_->table->close(call); });
}

std::int64_t DataFile::row_count() const {
    return impl_->table->row_count();
}

}  // namespace pogosim
