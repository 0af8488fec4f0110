#include "record/message_log.hpp"

#include <utility>

#include "record/tables_module.hpp"

namespace pogosim {

namespace {

TablesModule const& module_for(std::string const& path) {
    return tables_module_to_write("message log", path, "message_log");
}

}  // namespace

struct MessageLog::Impl {
    explicit Impl(WrittenMessageLog* written) : table(written) {}

    WrittenMessageLog* table;
};

LockedFile MessageLog::reserve(std::string const& path) {
    TablesModule const& module = module_for(path);
    return call_tables([&](TablesCall& call) { return module.reserve_message_log(path, call); });
}

MessageLog::MessageLog(MessageLogOptions const& options, LockedFile file) {
    TablesModule const& module = module_for(options.path);
    impl_ = std::make_unique<Impl>(
        call_tables([&](TablesCall& call) { return module.open_message_log(options, std::move(file), call); }));
}

MessageLog::~MessageLog() {
    TablesCall call{.log = &current_log()};
    impl_->table->destroy(call);
}

void MessageLog::append(MessageRow const& row) {
    call_tables([&](TablesCall& call) { impl_->table->append(row, call); });
}

void MessageLog::save_if_due() {
    call_tables([&](TablesCall& call) { impl_->table->save_if_due(call); });
}

void MessageLog::save() {
    call_tables([&](TablesCall& call) { impl_->table->save(call); });
}

void MessageLog::add_metadata(std::string const& key, std::string const& value) {
    call_tables([&](TablesCall& call) { impl_->table->add_metadata(key, value, call); });
}

void MessageLog::close() {
    call_tables([&](TablesCall& call) { impl_->table->close(call); });
}

}  // namespace pogosim
