#include "tables/module.hpp"

#include <exception>
#include <memory>
#include <new>
#include <utility>

#include "base/error.hpp"
#include "base/scratch_file.hpp"
#include "tables/data_file_writer.hpp"
#include "tables/imported_poses.hpp"
#include "tables/message_log_writer.hpp"

namespace pogosim {

namespace {

/// Returns action(), or tells the caller what it has thrown.
template <class Action>
auto reported(TablesCall& call, Action const& action) -> decltype(action()) {
    using Error = TablesCall::Error;
    auto const fail = [&call](Error error, char const* what) {
        call.error = error;
        call.what = what;
    };
    LogScope const scope(call.log);
    try {
        return action();
    } catch (ConfigError const& error) {
        fail(Error::config, error.what());
    } catch (OutputError const& error) {
        fail(Error::output, error.what());
    } catch (std::bad_alloc const& error) {
        fail(Error::memory, error.what());
    } catch (std::exception const& error) {
        fail(Error::other, error.what());
    }
    return decltype(action())();
}

/// A writer with the interface of the module.
template <class Writer, class Interface>
class Written : public Interface {
public:
    template <class Options>
    Written(Options const& options, LockedFile file) : writer_(std::make_unique<Writer>(options, std::move(file))) {}

    void save_if_due(TablesCall& call) final {
        reported(call, [this] { writer_->save_if_due(); });
    }
    void save(TablesCall& call) final {
        reported(call, [this] { writer_->save(); });
    }
    void add_metadata(std::string const& key, std::string const& value, TablesCall& call) final {
        reported(call, [&] { writer_->add_metadata(key, value); });
    }
    void close(TablesCall& call) final {
        reported(call, [this] { writer_->close(); });
    }
    std::int64_t row_count() const final { return writer_->row_count(); }

protected:
    ~Written() = default;

    std::unique_ptr<Writer> writer_;
};

class DataFileOfModule final : public Written<DataFileWriter, WrittenDataFile> {
public:
    using Written::Written;

    void append(std::span<ObjectRow const> rows, std::span<CellValue const> user, TablesCall& call) override {
        reported(call, [&] { writer_->append(rows, user); });
    }
    void destroy(TablesCall& call) override {
        reported(call, [this] { delete this; });
    }
};

class MessageLogOfModule final : public Written<MessageLogWriter, WrittenMessageLog> {
public:
    using Written::Written;

    void append(MessageRow const& row, TablesCall& call) override {
        reported(call, [&] { writer_->append(row); });
    }
    void destroy(TablesCall& call) override {
        reported(call, [this] { delete this; });
    }
};

LockedFile reserve_data_file(std::string const& path, TablesCall& call) {
    return reported(call, [&] { return DataFileWriter::reserve(path); });
}

LockedFile reserve_message_log(std::string const& path, TablesCall& call) {
    return reported(call, [&] { return MessageLogWriter::reserve(path); });
}

WrittenDataFile* open_data_file(DataFileOptions const& options, LockedFile file, TablesCall& call) {
    return reported(call, [&] { return new DataFileOfModule(options, std::move(file)); });
}

WrittenMessageLog* open_message_log(MessageLogOptions const& options, LockedFile file, TablesCall& call) {
    return reported(call, [&] { return new MessageLogOfModule(options, std::move(file)); });
}

ImportedPoses read_imported_feather(std::filesystem::path const& path, TablesCall& call) {
    return reported(call, [&] { return read_poses(path); });
}

constexpr TablesModule kModule{.reserve_data_file = reserve_data_file,
                               .reserve_message_log = reserve_message_log,
                               .open_data_file = open_data_file,
                               .open_message_log = open_message_log,
                               .read_imported_feather = read_imported_feather};

}  // namespace

TablesModule const* get_tables_module(TablesHost const& host) {
    share_scratch_files(host.scratch_files);
    share_save_progress(*host.save_progress);
    return &kModule;
}

}  // namespace pogosim

extern "C" __attribute__((visibility("default"))) pogosim::TablesModule const* pogosim_tables_module(
    pogosim::TablesHost const& host) {
    return pogosim::get_tables_module(host);
}
