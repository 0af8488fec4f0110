// The file of the message log: its cells, and what is said when it cannot be written.
#include "record/message_log.hpp"

#include <sys/stat.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "record/data_file.hpp"
#include "scratch.hpp"
#include "support/file_size_limit.hpp"

namespace pogosim {
namespace {

using MessageLogFile = FileTest;

constexpr std::array kPayload{std::byte{0x00}, std::byte{0xFF}, std::byte{0x41}};

MessageRow row_to_nobody(int step) {
    return {.time_s = 0.01F * static_cast<float>(step),
            .step = step,
            .message = step,
            .sender = {.index = 4, .id = 40, .category = "robots"},
            .faces = 0b1111,
            .type = MessageType::short_message,
            .payload = kPayload,
            .message_bytes = 6,
            .send_probability = 0.5F};
}

MessageRow row_to_a_wall(int step) {
    MessageRow row = row_to_nobody(step);
    row.type = MessageType::long_message;
    row.reception = {.receiver = {.index = 5, .id = 65535, .category = "walls"},
                     .emitters = 0b0010,
                     .faces = 0b0001,
                     .cluster_size = 2,
                     .probability = 0.25F,
                     .outcome = MessageOutcome::queue_full};
    return row;
}

TEST_F(MessageLogFile, CellsComeBackAsTheyWereGiven) {
    MessageLog log({.path = path("m.feather"), .metadata = {{"configuration", "a: 1"}}});
    MessageRow row = row_to_a_wall(150);
    row.reception->distance_mm = 12.5F;
    row.reception->outcome = MessageOutcome::heard;
    row.reception->copies = 2;
    log.append(row);
    log.close();
    auto const data = read_back(path("m.feather"));
    ASSERT_EQ(data.table->num_rows(), 1);
    std::vector<std::pair<char const*, char const*>> const expected{
        {"time", "1.5"},          {"step", "150"},
        {"message", "150"},       {"sender", "4"},
        {"sender_id", "40"},      {"sender_category", "robots"},
        {"sender_faces", "15"},   {"kind", "long"},
        {"message_bytes", "6"},   {"send_probability", "0.5"},
        {"cluster_size", "2"},    {"receiver", "5"},
        {"receiver_id", "65535"}, {"receiver_category", "walls"},
        {"distance", "12.5"},     {"reaching_faces", "2"},
        {"receiver_faces", "1"},  {"probability", "0.25"},
        {"outcome", "heard"},     {"copies", "2"}};
    EXPECT_EQ(data.table->num_columns(), static_cast<int>(expected.size()) + 1);
    for (auto const& [name, text] : expected) {
        EXPECT_EQ(data.text(name, 0), text) << name;
    }
    auto const payload = std::static_pointer_cast<arrow::BinaryScalar>(data.cell("payload", 0));
    EXPECT_EQ(payload->value->ToString(), std::string("\x00\xFF\x41", 3));
    EXPECT_EQ(data.table->schema()->metadata()->Get("configuration").ValueOrDie(), "a: 1");
}

TEST_F(MessageLogFile, TimesAreRoundedToNanoseconds) {
    MessageLog log({.path = path("m.feather")});
    MessageRow row = row_to_nobody(1);
    row.time_s = 0.1 + 0.2;  // 0.30000000000000004
    log.append(row);
    log.close();
    auto const time = read_back(path("m.feather")).cell("time", 0);
    EXPECT_EQ(std::static_pointer_cast<arrow::DoubleScalar>(time)->value, 0.3);
}

TEST_F(MessageLogFile, MessageToNoRobotHasNullsForTheReceiver) {
    MessageLog log({.path = path("m.feather")});
    log.append(row_to_nobody(1));
    log.append(row_to_a_wall(2));
    log.close();
    auto const data = read_back(path("m.feather"));
    for (auto const* name : {"receiver", "receiver_id", "receiver_category", "distance", "reaching_faces",
                             "receiver_faces", "probability"}) {
        EXPECT_FALSE(data.cell(name, 0)->is_valid) << name;
    }
    EXPECT_EQ(data.text("outcome", 0), "nobody_in_reach");
    EXPECT_EQ(data.text("cluster_size", 0), "1");
    EXPECT_EQ(data.text("copies", 0), "0");
    EXPECT_EQ(data.text("kind", 0), "short");
    EXPECT_EQ(data.text("outcome", 1), "queue_full");
    EXPECT_FALSE(data.cell("distance", 1)->is_valid);
}

TEST_F(MessageLogFile, HoldsItsRowsBeforeItIsComplete) {
    MessageLog log({.path = path("m.feather"), .flush_row_count = 3});
    for (int step = 0; step < 10; ++step) {
        log.append(step % 2 == 0 ? row_to_nobody(step) : row_to_a_wall(step));
    }
    log.save();
    auto const saved = read_unfinished(path("m.feather"));
    EXPECT_EQ(saved->num_rows(), 10);
    log.close();
    auto const data = read_back(path("m.feather"));
    EXPECT_TRUE(data.table->Equals(*saved));
    EXPECT_EQ(data.rows_of_batch, (std::vector<std::int64_t>{3, 3, 3, 1}));
}

TEST_F(MessageLogFile, IsCompletedBesideADataFile) {
    {
        DataFile data({.path = path("a.feather"), .flush_row_count = 1});
        MessageLog log({.path = path("m.feather"), .flush_row_count = 1});
        for (int i = 0; i < 3; ++i) {
            data.append({.time_s = static_cast<float>(i), .category = "robots"}, {});
            log.append(row_to_nobody(i));
        }
        data.close();
        log.close();
    }
    EXPECT_EQ(files_in_folder(), (std::vector<std::string>{"a.feather", "m.feather"}));
    EXPECT_EQ(read_back(path("m.feather")).table->num_rows(), 3);
    EXPECT_EQ(read_back(path("a.feather")).table->num_rows(), 3);
}

std::string error_of(std::function<void()> const& action) {
    try {
        action();
    } catch (OutputError const& error) {
        return error.what();
    }
    return {};
}

TEST_F(MessageLogFile, ThatCannotBeWrittenSaysSoWithItsKey) {
    auto const opened = [](std::string const& name) {
        return error_of([&name] { MessageLog const log({.path = name}); });
    };
    std::filesystem::create_directory(path("folder"));
    EXPECT_EQ(opened(path("folder")),
              "cannot write the message log '" + path("folder") + "' (message_log): Is a directory");
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    EXPECT_EQ(opened(path("pipe")), "cannot write the message log '" + path("pipe") +
                                        "' (message_log): it is a device, a pipe or a socket, not a file; to run "
                                        "without a message log: leave message_log out");
    std::ofstream(path("file")) << "x";
    EXPECT_NE(opened(path("file/m.feather")).find("(message_log): cannot make the folder"), std::string::npos);
}

TEST_F(MessageLogFile, OnAFullDiskKeepsItsFirstRows) {
    std::string message;
    {
        MessageLog log({.path = path("m.feather"), .flush_row_count = 1000});
        FileSizeLimit const limit(200000);
        message = error_of([&log] {
            for (int i = 0; i < 1000000; ++i) {
                log.append(row_to_a_wall(i));
            }
        });
    }
    EXPECT_NE(message.find("cannot write the message log"), std::string::npos) << message;
    EXPECT_NE(message.find("pogosim-recover '" + path("m.feather") + "'"), std::string::npos) << message;
    EXPECT_GT(read_unfinished(path("m.feather"))->num_rows(), 0);
}

}  // namespace
}  // namespace pogosim
