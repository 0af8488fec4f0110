// Writes the message log: what is behind MessageLog (record/message_log.hpp), whose functions these are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/locked_file.hpp"
#include "record/message_log.hpp"

namespace pogosim {

class MessageLogWriter {
public:
    static LockedFile reserve(std::string const& path);
    MessageLogWriter(MessageLogOptions const& options, LockedFile file);
    ~MessageLogWriter();

    MessageLogWriter(MessageLogWriter const&) = delete;
    MessageLogWriter& operator=(MessageLogWriter const&) = delete;

    void append(MessageRow const& row);
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
