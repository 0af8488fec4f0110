#include "tables/message_log_writer.hpp"

#include <arrow/api.h>

#include <array>

#include "base/rounded_time.hpp"
#include "tables/table_file.hpp"
#include "tables/table_memory.hpp"

namespace pogosim {

using arrow::Status;

namespace {

constexpr TableKind kKind{.name = "message log", .key = "message_log", .how_to_do_without = "leave message_log out"};

constexpr std::array<std::string_view, 4> kOutcomes{"heard", "lost", "queue_full", "malformed"};
constexpr std::array<std::string_view, 4> kTypes{"long", "short", "command", "other"};
constexpr std::string_view kNoRobotInReach = "nobody_in_reach";

/// Appends the cells of a robot, or nulls.
struct RobotCells {
    arrow::MemoryPool* memory;
    arrow::Int32Builder index{memory};
    arrow::Int32Builder id{memory};
    arrow::StringBuilder category{memory};

    Status append(LoggedRobot const& robot) {
        ARROW_RETURN_NOT_OK(index.Append(robot.index));
        ARROW_RETURN_NOT_OK(id.Append(robot.id));
        return category.Append(robot.category);
    }

    Status append_null() {
        ARROW_RETURN_NOT_OK(index.AppendNull());
        ARROW_RETURN_NOT_OK(id.AppendNull());
        return category.AppendNull();
    }
};

struct Cells {
    arrow::MemoryPool* memory;
    arrow::DoubleBuilder time{memory};
    arrow::Int64Builder step{memory};
    arrow::Int64Builder message{memory};
    RobotCells sender{memory};
    arrow::Int8Builder sender_faces{memory};
    arrow::StringBuilder kind{memory};
    arrow::BinaryBuilder payload{memory};
    arrow::Int32Builder message_bytes{memory};
    arrow::FloatBuilder send_probability{memory};
    arrow::Int32Builder cluster_size{memory};
    RobotCells receiver{memory};
    arrow::FloatBuilder distance{memory};
    arrow::Int8Builder emitters{memory};
    arrow::Int8Builder receiver_faces{memory};
    arrow::FloatBuilder probability{memory};
    arrow::StringBuilder outcome{memory};
    arrow::Int8Builder copies{memory};

    struct Column {
        char const* name;
        arrow::ArrayBuilder* cells;
    };

    /// The columns in the order of the file.
    std::array<Column, 21> columns() {
        return {{{"time", &time},
                 {"step", &step},
                 {"message", &message},
                 {"sender", &sender.index},
                 {"sender_id", &sender.id},
                 {"sender_category", &sender.category},
                 {"sender_faces", &sender_faces},
                 {"kind", &kind},
                 {"payload", &payload},
                 {"message_bytes", &message_bytes},
                 {"send_probability", &send_probability},
                 {"cluster_size", &cluster_size},
                 {"receiver", &receiver.index},
                 {"receiver_id", &receiver.id},
                 {"receiver_category", &receiver.category},
                 {"distance", &distance},
                 {"reaching_faces", &emitters},
                 {"receiver_faces", &receiver_faces},
                 {"probability", &probability},
                 {"outcome", &outcome},
                 {"copies", &copies}}};
    }

    arrow::FieldVector fields() {
        arrow::FieldVector fields;
        for (auto const& [name, cells] : columns()) {
            fields.push_back(arrow::field(name, cells->type()));
        }
        return fields;
    }

    arrow::Result<arrow::ArrayVector> take() {
        arrow::ArrayVector arrays;
        for (auto const& [name, cells] : columns()) {
            ARROW_RETURN_NOT_OK(cells->Finish(&arrays.emplace_back()));
        }
        return arrays;
    }

    Status append(MessageRow const& row) {
        ARROW_RETURN_NOT_OK(time.Append(rounded_to_ns(row.time_s)));
        ARROW_RETURN_NOT_OK(step.Append(row.step));
        ARROW_RETURN_NOT_OK(message.Append(row.message));
        ARROW_RETURN_NOT_OK(sender.append(row.sender));
        ARROW_RETURN_NOT_OK(sender_faces.Append(static_cast<std::int8_t>(row.faces)));
        ARROW_RETURN_NOT_OK(kind.Append(kTypes[static_cast<std::size_t>(row.type)]));
        ARROW_RETURN_NOT_OK(payload.Append(reinterpret_cast<std::uint8_t const*>(row.payload.data()),
                                           static_cast<std::int32_t>(row.payload.size())));
        ARROW_RETURN_NOT_OK(message_bytes.Append(row.message_bytes));
        ARROW_RETURN_NOT_OK(send_probability.Append(row.send_probability));
        return row.reception ? append(*row.reception) : append_no_receiver();
    }

    Status append(LoggedReception const& reception) {
        ARROW_RETURN_NOT_OK(cluster_size.Append(reception.cluster_size));
        ARROW_RETURN_NOT_OK(receiver.append(reception.receiver));
        ARROW_RETURN_NOT_OK(reception.distance_mm ? distance.Append(*reception.distance_mm) : distance.AppendNull());
        ARROW_RETURN_NOT_OK(emitters.Append(static_cast<std::int8_t>(reception.emitters)));
        ARROW_RETURN_NOT_OK(receiver_faces.Append(static_cast<std::int8_t>(reception.faces)));
        ARROW_RETURN_NOT_OK(probability.Append(reception.probability));
        ARROW_RETURN_NOT_OK(outcome.Append(kOutcomes[static_cast<std::size_t>(reception.outcome)]));
        return copies.Append(reception.copies);
    }

    Status append_no_receiver() {
        ARROW_RETURN_NOT_OK(cluster_size.Append(1));
        ARROW_RETURN_NOT_OK(receiver.append_null());
        ARROW_RETURN_NOT_OK(distance.AppendNull());
        ARROW_RETURN_NOT_OK(emitters.AppendNull());
        ARROW_RETURN_NOT_OK(receiver_faces.AppendNull());
        ARROW_RETURN_NOT_OK(probability.AppendNull());
        ARROW_RETURN_NOT_OK(outcome.Append(kNoRobotInReach));
        return copies.Append(0);
    }
};

}  // namespace

struct MessageLogWriter::Impl {
    TableMemory memory;
    Cells cells{&memory};
    TableFile table;

    Impl(MessageLogOptions const& options, LockedFile file)
        : table({.kind = kKind,
                 .path = options.path,
                 .flush_row_count = options.flush_row_count,
                 .metadata = options.metadata,
                 .memory = &memory},
                std::move(file), cells.fields(), [this] { return cells.take(); }) {}
};

LockedFile MessageLogWriter::reserve(std::string const& path) {
    return TableFile::reserve(kKind, path);
}

MessageLogWriter::MessageLogWriter(MessageLogOptions const& options, LockedFile file)
    : impl_(std::make_unique<Impl>(options, std::move(file))) {}

MessageLogWriter::~MessageLogWriter() = default;

void MessageLogWriter::append(MessageRow const& row) {
    impl_->table.count_rows(row.time_s, 1, status_of([&] { return impl_->cells.append(row); }));
}

void MessageLogWriter::save_if_due() {
    impl_->table.save_if_due();
}

void MessageLogWriter::save() {
    impl_->table.save();
}

void MessageLogWriter::add_metadata(std::string const& key, std::string const& value) {
    impl_->table.add_metadata(key, value);
}

void MessageLogWriter::close() {
    impl_->table.close();
}

std::int64_t MessageLogWriter::row_count() const {
    return impl_->table.row_count();
}

}  // namespace pogosim
