// Writes what became of every message into the message log.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "comms/delivery_log.hpp"
#include "record/message_log.hpp"
#include "world/world.hpp"

namespace pogosim {

class MessageRecorder {
public:
    /// Locks the file, so that no other run writes it. `world` outlives this. Throws OutputError.
    MessageRecorder(std::string const& path, World const& world);

    /// Empties the file. Throws OutputError.
    void open(MessageLogOptions const& options);

    bool is_open() const { return log_ != nullptr; }
    bool is_complete() const { return is_complete_; }

    /// Messages recorded so far, from whose number the next ones are counted.
    std::int64_t count() const { return messages_; }
    void go_on_from(std::int64_t count) { messages_ = count; }

    /// What the next step fills; empty before.
    DeliveryLog& deliveries() { return deliveries_; }

    /// Writes a row for each delivery, and forgets them. Throws OutputError.
    void record();

    void save_if_due();
    void save();
    void add_metadata(std::string const& key, std::string const& value);

    /// Completes the file. Throws OutputError.
    void close();

private:
    World const& world_;
    LockedFile reserved_;  // until there is a log
    std::unique_ptr<MessageLog> log_;
    DeliveryLog deliveries_;
    std::int64_t messages_ = 0;  // recorded so far, also by the run that was saved
    bool is_complete_ = false;
};

}  // namespace pogosim
