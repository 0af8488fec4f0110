#include "record/data_file.hpp"

#include <spdlog/sinks/ostream_sink.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/half.hpp"
#include "base/log.hpp"
#include "scratch.hpp"

namespace pogosim {
namespace {

using DataFileContent = FileTest;
using DataFileColumns = FileTest;

std::vector<ColumnSpec> const kOneColumnOfEachType{
    {"i8", ColumnType::int8},     {"i16", ColumnType::int16},   {"i32", ColumnType::int32},
    {"i64", ColumnType::int64},   {"f64", ColumnType::float64}, {"text", ColumnType::text},
    {"yes", ColumnType::boolean}, {"f16", ColumnType::float16},
};

ObjectRow robot_row(int id, double time_s) {
    return {.time_s = time_s,
            .category = "robots",
            .id = id,
            .ticks = 60 * id,
            .x_mm = 100.0F + static_cast<float>(id),
            .y_mm = 200.5F,
            .angle_rad = -1.25F};
}

/// Writes `rows` rows with one user column holding the row's number.
void write_numbered_rows(DataFileOptions options, int rows) {
    options.user_columns = {{"number", ColumnType::int64}};
    DataFile file(options);
    for (int i = 0; i < rows; ++i) {
        file.append(robot_row(i % 7, 0.5 * (i / 7)), {std::int64_t{i}});
    }
    file.close();
}

/// What is logged while it lives, without date and level.
class LogCatcher {
public:
    LogCatcher() : sink_(std::make_shared<spdlog::sinks::ostream_sink_st>(text_)) {
        sink_->set_pattern("%l: %v");
        log().sinks().push_back(sink_);
    }
    ~LogCatcher() { log().sinks().pop_back(); }

    std::string text() const { return text_.str(); }

private:
    std::ostringstream text_;
    std::shared_ptr<spdlog::sinks::sink> sink_;
};

// ---- content --------------------------------------------------------------------------------------------------------

TEST_F(DataFileContent, BuiltInCellsComeBackAsTheyWereGiven) {
    DataFile file({.path = path("a.feather"), .subpart_column = true, .led_column = true, .tension_column = true});
    ObjectRow row = robot_row(3, 1.5);
    row.subpart = 12;
    row.led_rgb = 0x19FF00;
    row.tension_n = -0.5F;
    file.append(row, {});
    file.close();

    auto const data = read_back(path("a.feather"));
    ASSERT_EQ(data.table->num_rows(), 1);
    EXPECT_EQ(data.text("time", 0), "1.5");
    EXPECT_EQ(data.text("robot_category", 0), "robots");
    EXPECT_EQ(data.text("robot_id", 0), "3");
    EXPECT_EQ(data.text("pogobot_ticks", 0), "180");
    EXPECT_EQ(data.text("x", 0), "103");
    EXPECT_EQ(data.text("y", 0), "200.5");
    EXPECT_EQ(data.text("angle", 0), "-1.25");
    EXPECT_EQ(data.text("subpart_id", 0), "12");
    EXPECT_EQ(data.text("led_rgb", 0), std::to_string(0x19FF00));
    EXPECT_EQ(data.text("tension", 0), "-0.5");
}

TEST_F(DataFileContent, WallHasNanPoseAndNoTicks) {
    DataFile file({.path = path("a.feather")});
    float const nan = std::numeric_limits<float>::quiet_NaN();
    file.append({.category = "walls", .id = 65535, .x_mm = nan, .y_mm = nan, .angle_rad = nan}, {});
    file.close();

    auto const data = read_back(path("a.feather"));
    EXPECT_FALSE(data.cell("pogobot_ticks", 0)->is_valid);
    for (auto const* pose : {"x", "y", "angle"}) {
        auto const cell = std::static_pointer_cast<arrow::FloatScalar>(data.cell(pose, 0));
        EXPECT_TRUE(cell->is_valid && std::isnan(cell->value)) << pose;
    }
}

TEST_F(DataFileContent, UserCellsOfEveryTypeKeepTheirExtremes) {
    DataFile file({.path = path("a.feather"), .user_columns = kOneColumnOfEachType});
    auto const min = std::numeric_limits<std::int64_t>::min();
    auto const max = std::numeric_limits<std::int64_t>::max();
    using I = std::int64_t;
    file.append(robot_row(0, 0.0),
                {I{-128}, I{-32768}, I{-2147483648LL}, min, 0.1, std::string("d\xC3\xA9j\xC3\xA0"), true, 65504.0});
    file.append(robot_row(1, 0.0), {I{127}, I{32767}, I{2147483647}, max, -1.0e300, std::string(), false, -0.1});
    file.close();

    auto const data = read_back(path("a.feather"));
    std::vector<std::vector<std::string>> const expected{
        {"-128", "-32768", "-2147483648", "-9223372036854775808", "0.1", "d\xC3\xA9j\xC3\xA0", "true"},
        {"127", "32767", "2147483647", "9223372036854775807", "-1e+300", "", "false"}};
    for (std::size_t row = 0; row < expected.size(); ++row) {
        for (std::size_t column = 0; column < expected[row].size(); ++column) {
            auto const& name = kOneColumnOfEachType[column].name;
            EXPECT_EQ(data.text(name, static_cast<std::int64_t>(row)), expected[row][column]) << name;
        }
    }
    auto const half = [&data](std::int64_t row) {
        return std::static_pointer_cast<arrow::HalfFloatArray>(data.table->GetColumnByName("f16")->chunk(0))
            ->Value(row);
    };
    EXPECT_EQ(half(0), 0x7BFF);
    EXPECT_EQ(half(1), to_half(-0.1));
}

TEST_F(DataFileContent, CellsThatTheUserDidNotSetAreNull) {
    DataFile file({.path = path("a.feather"), .user_columns = kOneColumnOfEachType});
    file.append(robot_row(0, 0.0), std::vector<CellValue>(kOneColumnOfEachType.size()));
    file.close();

    auto const data = read_back(path("a.feather"));
    for (auto const& column : kOneColumnOfEachType) {
        EXPECT_FALSE(data.cell(column.name, 0)->is_valid) << column.name;
    }
}

TEST_F(DataFileContent, TextThatIsNotUtf8StaysReadable) {
    DataFile file({.path = path("a.feather"),
                   .user_columns = {{"te\xFFxt", ColumnType::text}},
                   .metadata = {{"note", "caf\xE9"}}});
    file.append(robot_row(0, 0.0), {std::string("a\xFF"
                                                "b")});
    file.close();

    auto const data = read_back(path("a.feather"));
    EXPECT_EQ(data.text("te\xEF\xBF\xBDxt", 0),
              "a\xEF\xBF\xBD"
              "b");
    EXPECT_EQ(data.table->schema()->metadata()->Get("note").ValueOrDie(), "caf\xEF\xBF\xBD");
}

TEST_F(DataFileContent, FileWithoutRowsIsReadable) {
    DataFile file({.path = path("a.feather"), .user_columns = kOneColumnOfEachType});
    file.close();
    EXPECT_EQ(file.row_count(), 0);

    auto const data = read_back(path("a.feather"));
    EXPECT_EQ(data.table->num_rows(), 0);
    EXPECT_EQ(data.table->num_columns(), 15);
}

TEST_F(DataFileContent, RowsAreSplitIntoBatchesAndKeepTheirOrder) {
    write_numbered_rows({.path = path("a.feather"), .flush_row_count = 100}, 250);

    auto const data = read_back(path("a.feather"));
    EXPECT_EQ(data.rows_of_batch, (std::vector<std::int64_t>{100, 100, 50}));
    for (int i = 0; i < 250; ++i) {
        ASSERT_EQ(data.text("number", i), std::to_string(i));
    }
}

TEST_F(DataFileContent, RowsAddedTogetherAreThoseAddedOneByOne) {
    std::size_t const columns = kOneColumnOfEachType.size();
    std::vector<ObjectRow> rows;
    std::vector<CellValue> cells;
    for (int i = 0; i < 25; ++i) {
        rows.push_back(robot_row(i, 1.0));
        rows.back().category = i % 3 == 0 ? "robots" : "walls";
        rows.back().ticks = i % 4 == 0 ? std::nullopt : rows.back().ticks;
        for (std::int64_t const number : {std::int64_t{i}, std::int64_t{2}, std::int64_t{3}, std::int64_t{4}}) {
            cells.emplace_back(number);
        }
        cells.emplace_back(0.5 * i);
        cells.emplace_back(std::to_string(i));
        cells.emplace_back(i % 2 == 0);
        cells.emplace_back(1.5);
        cells[cells.size() - 1 - static_cast<std::size_t>(i) % columns] = {};  // null
    }
    auto const write = [&](std::string const& name, auto const& append) {
        DataFile file({.path = path(name), .user_columns = kOneColumnOfEachType, .flush_row_count = 10});
        append(file);
        EXPECT_EQ(file.row_count(), 25);
        file.close();
    };
    write("together.feather", [&](DataFile& file) { file.append(rows, cells); });
    write("one_by_one.feather", [&](DataFile& file) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            file.append(rows[i], std::span(cells).subspan(i * columns, columns));
        }
    });
    EXPECT_EQ(bytes_of(path("together.feather")), bytes_of(path("one_by_one.feather")));
    EXPECT_EQ(read_back(path("together.feather")).rows_of_batch, (std::vector<std::int64_t>{10, 10, 5}));
}

TEST_F(DataFileContent, FullLastBatchIsNotFollowedByAnEmptyOne) {
    write_numbered_rows({.path = path("a.feather"), .flush_row_count = 100}, 200);
    EXPECT_EQ(read_back(path("a.feather")).rows_of_batch, (std::vector<std::int64_t>{100, 100}));
}

TEST_F(DataFileContent, SameRowsGiveTheSameBytes) {
    for (auto const* name : {"a.feather", "b.feather"}) {
        write_numbered_rows({.path = path(name), .flush_row_count = 1000, .metadata = {{"configuration", "seed: 0"}}},
                            5000);
    }
    EXPECT_EQ(bytes_of(path("a.feather")), bytes_of(path("b.feather")));
}

TEST_F(DataFileContent, ColumnsAreCompressed) {
    write_numbered_rows({.path = path("a.feather")}, 100000);
    EXPECT_LT(std::filesystem::file_size(path("a.feather")), 100000 * 5);  // of 46 bytes per row
}

TEST_F(DataFileContent, MetadataStandsInTheSchemaInItsOrder) {
    std::vector<std::pair<std::string, std::string>> const metadata{
        {"program_version", "v1.2.3"}, {"configuration", "a: 1\nb: \"\xC3\xA9\"\n"}, {"arena_polygons", "[]"}};
    DataFile file({.path = path("a.feather"), .metadata = metadata});
    file.close();

    auto const read = read_back(path("a.feather")).table->schema()->metadata();
    ASSERT_EQ(read->size(), std::ssize(metadata));
    for (std::int64_t i = 0; i < read->size(); ++i) {
        EXPECT_EQ(read->key(i), metadata[static_cast<std::size_t>(i)].first);
        EXPECT_EQ(read->value(i), metadata[static_cast<std::size_t>(i)].second);
    }
}

TEST_F(DataFileContent, MetadataAddedDuringTheRunStandsBehindTheOther) {
    for (int const flush_row_count : {10, 49, 50, 1000}) {  // batches before, none left, none before
        DataFileOptions const options{.path = path("a.feather"),
                                      .flush_row_count = flush_row_count,
                                      .metadata = {{"program_version", "v1.2.3"}, {"configuration", "a: 1"}}};
        DataFile file(options);
        for (int i = 0; i < 50; ++i) {
            file.append(robot_row(i, 0.0), {});
        }
        file.add_metadata("touched", "once \xFF");
        file.close();

        auto const data = read_back(path("a.feather"));
        auto const read = data.table->schema()->metadata();
        EXPECT_EQ(read->keys(), (std::vector<std::string>{"program_version", "configuration", "touched"}));
        EXPECT_EQ(read->Get("touched").ValueOrDie(), "once \xEF\xBF\xBD");
        ASSERT_EQ(data.table->num_rows(), 50);
        for (int i = 0; i < 50; ++i) {
            EXPECT_EQ(data.text("robot_id", i), std::to_string(i));
        }
        EXPECT_EQ(data.rows_of_batch.front(), std::min(flush_row_count, 50));
        EXPECT_EQ(files_in_folder(), std::vector<std::string>{"a.feather"});
    }
}

TEST_F(DataFileContent, EarlierFileIsReplaced) {
    write_numbered_rows({.path = path("a.feather")}, 1000);
    write_numbered_rows({.path = path("a.feather")}, 10);
    EXPECT_EQ(read_back(path("a.feather")).table->num_rows(), 10);
}

TEST_F(DataFileContent, ParentFoldersAreCreated) {
    write_numbered_rows({.path = path("some/deep folder/a.feather")}, 10);
    EXPECT_EQ(read_back(path("some/deep folder/a.feather")).table->num_rows(), 10);
}

TEST_F(DataFileContent, EndOfScopeClosesAsCloseDoes) {
    {
        DataFile file({.path = path("a.feather")});
        file.append(robot_row(0, 0.0), {});
        EXPECT_EQ(file.row_count(), 1);
    }
    EXPECT_EQ(read_back(path("a.feather")).table->num_rows(), 1);
}

TEST_F(DataFileContent, SecondCloseDoesNothing) {
    DataFile file({.path = path("a.feather")});
    file.close();
    auto const bytes = bytes_of(path("a.feather"));
    file.close();
    EXPECT_EQ(bytes_of(path("a.feather")), bytes);
}

// ---- columns --------------------------------------------------------------------------------------------------------

TEST_F(DataFileColumns, HaveTheDocumentedOrderAndTypes) {
    DataFile file(
        {.path = path("a.feather"), .user_columns = kOneColumnOfEachType, .subpart_column = true, .led_column = true});
    file.close();

    auto const data = read_back(path("a.feather"));
    std::vector<std::pair<std::string, std::shared_ptr<arrow::DataType>>> const expected{
        {"time", arrow::float64()},   {"robot_category", arrow::utf8()},
        {"robot_id", arrow::int32()}, {"pogobot_ticks", arrow::int64()},
        {"x", arrow::float32()},      {"y", arrow::float32()},
        {"angle", arrow::float32()},  {"subpart_id", arrow::int16()},
        {"led_rgb", arrow::int32()},  {"i8", arrow::int8()},
        {"i16", arrow::int16()},      {"i32", arrow::int32()},
        {"i64", arrow::int64()},      {"f64", arrow::float64()},
        {"text", arrow::utf8()},      {"yes", arrow::boolean()},
        {"f16", arrow::float16()}};
    ASSERT_EQ(data.table->num_columns(), std::ssize(expected));
    for (int i = 0; i < data.table->num_columns(); ++i) {
        auto const& [name, type] = expected[static_cast<std::size_t>(i)];
        EXPECT_EQ(data.table->field(i)->name(), name);
        EXPECT_TRUE(data.table->field(i)->type()->Equals(type)) << name;
    }
}

TEST_F(DataFileColumns, SubpartAndLedAreThereOnlyWhenAskedFor) {
    DataFile file({.path = path("a.feather")});
    file.close();
    EXPECT_EQ(read_back(path("a.feather")).column_names(),
              (std::vector<std::string>{"time", "robot_category", "robot_id", "pogobot_ticks", "x", "y", "angle"}));
}

TEST_F(DataFileColumns, AllowListKeepsTheOrderOfTheFileAndTheRightCells) {
    DataFile file(
        {.path = path("a.feather"), .user_columns = kOneColumnOfEachType, .fields = {{"f64", "x", "i16", "time"}}});
    using I = std::int64_t;
    file.append(robot_row(5, 2.0), {I{1}, I{2}, I{3}, I{4}, 5.5, std::string("six"), true, 8.0});
    file.close();

    auto const data = read_back(path("a.feather"));
    EXPECT_EQ(data.column_names(), (std::vector<std::string>{"time", "x", "i16", "f64"}));
    EXPECT_EQ(data.text("time", 0), "2");
    EXPECT_EQ(data.text("x", 0), "105");
    EXPECT_EQ(data.text("i16", 0), "2");
    EXPECT_EQ(data.text("f64", 0), "5.5");
}

TEST_F(DataFileColumns, UnknownFieldIsWarnedAboutWithTheNearestName) {
    LogCatcher const caught;
    DataFile file({.path = path("a.feather"), .fields = {{"x", "robot_ids", "zzzzzzzz"}}});
    file.close();
    EXPECT_NE(caught.text().find("warning: data_logger_fields: there is no column 'robot_ids', did you mean "
                                 "'robot_id'?; the columns are: time, robot_category"),
              std::string::npos)
        << caught.text();
    EXPECT_NE(caught.text().find("there is no column 'zzzzzzzz'; the columns are:"), std::string::npos)
        << caught.text();
    EXPECT_EQ(read_back(path("a.feather")).column_names(), std::vector<std::string>{"x"});
}

/// Message of the ConfigError that these options give; empty if they give none.
std::string config_error(DataFileOptions const& options) {
    try {
        DataFile const file(options);
    } catch (ConfigError const& error) {
        return error.what();
    }
    return {};
}

TEST_F(DataFileColumns, AllowListThatLeavesNothingIsRefusedWithTheChoice) {
    LogCatcher const caught;
    for (auto const& fields : {std::vector<std::string>{}, std::vector<std::string>{"nothing_like_it"}}) {
        auto const message = config_error({.path = path("a.feather"), .fields = fields});
        EXPECT_NE(message.find("choose from: time, robot_category, robot_id"), std::string::npos) << message;
    }
    EXPECT_FALSE(std::filesystem::exists(path("a.feather")));
}

TEST_F(DataFileColumns, NameUsedTwiceIsRefused) {
    auto const twice = config_error(
        {.path = path("a.feather"), .user_columns = {{"age", ColumnType::int8}, {"age", ColumnType::float64}}});
    EXPECT_NE(twice.find("'age'"), std::string::npos) << twice;
    EXPECT_NE(twice.find("added before"), std::string::npos) << twice;

    auto const built_in = config_error({.path = path("a.feather"), .user_columns = {{"x", ColumnType::int8}}});
    EXPECT_NE(built_in.find("the simulator has a column of that name"), std::string::npos) << built_in;

    EXPECT_NE(config_error({.path = path("a.feather"), .user_columns = {{"subpart_id", ColumnType::int8}}}), "");
    EXPECT_NE(config_error({.path = path("a.feather"), .user_columns = {{"", ColumnType::int8}}}), "");
}

TEST_F(DataFileColumns, NameOfABuiltInColumnThatIsNotThereIsFree) {
    EXPECT_EQ(config_error({.path = path("a.feather"), .user_columns = {{"led_rgb", ColumnType::int32}}}), "");
    EXPECT_NE(
        config_error({.path = path("a.feather"), .user_columns = {{"led_rgb", ColumnType::int32}}, .led_column = true}),
        "");
}

}  // namespace
}  // namespace pogosim
