// The message log: a table like the data file, with one row for each transmission and robot in range, and one for each
// transmission without a robot in range.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/locked_file.hpp"

namespace pogosim {

struct MessageLogOptions {
    std::string path{};                                           // parent folders are created
    std::int64_t flush_row_count = 65536;                         // rows per record batch, > 0
    std::vector<std::pair<std::string, std::string>> metadata{};  // of the schema, UTF-8
};

/// A robot, as the columns name it.
struct LoggedRobot {
    std::int32_t index = 0;  // in order of creation
    std::int32_t id = 0;
    std::string_view category;
};

enum class MessageOutcome { heard, lost, queue_full, malformed };

enum class MessageType { long_message, short_message, command, other };

/// The fate of a transmission at one robot in reach.
struct LoggedReception {
    LoggedRobot receiver;
    std::optional<float> distance_mm{};  // from the emitter to the receiver's border; null to or from an outline
    std::uint8_t emitters = 0;           // bit d: emitter d of the sender reaches it
    std::uint8_t faces = 0;              // bit d: face d of the receiver sees the emitter
    std::int32_t cluster_size = 1;       // the sender and the robots in range
    float probability = 0.0F;            // of reception, 0 to 1
    MessageOutcome outcome = MessageOutcome::heard;
    std::int8_t copies = 0;  // that found room in the receiver's queue
};

struct MessageRow {
    double time_s = 0.0;
    std::int64_t step = 0;
    std::int64_t message = 0;  // number of the transmission in the run
    LoggedRobot sender;
    std::uint8_t faces = 0;  // bit d: emitter d radiates
    MessageType type = MessageType::long_message;
    std::span<std::byte const> payload{};
    std::int32_t message_bytes = 0;              // header and payload as the law of reception counts them
    float send_probability = 0.0F;               // of the sender, per tick
    std::optional<LoggedReception> reception{};  // null: no robot was in range
};

/// Columns: docs/message_log.md. Files, failures and bytes: as those of DataFile.
class MessageLog {
public:
    static LockedFile reserve(std::string const& path);

    explicit MessageLog(MessageLogOptions const& options) : MessageLog(options, reserve(options.path)) {}
    MessageLog(MessageLogOptions const& options, LockedFile file);
    ~MessageLog();

    MessageLog(MessageLog const&) = delete;
    MessageLog& operator=(MessageLog const&) = delete;

    void append(MessageRow const& row);
    void save_if_due();
    void save();
    void add_metadata(std::string const& key, std::string const& value);
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pogosim
