// The file on disk during a run, and how the complete file replaces it.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "record/data_file.hpp"
#include "scratch.hpp"
#include "support/file_size_limit.hpp"
#include "tables/unfinished_file.hpp"

namespace pogosim {
namespace {

using UnfinishedDataFile = FileTest;
using CompletedDataFile = FileTest;

std::vector<ColumnSpec> const kUserColumns{{"number", ColumnType::int64},
                                           {"text", ColumnType::text},
                                           {"yes", ColumnType::boolean},
                                           {"f16", ColumnType::float16}};

/// Rows with nulls here and there, in built-in and in user columns.
void append_rows(DataFile& file, int first, int count) {
    for (int i = first; i < first + count; ++i) {
        ObjectRow row{.time_s = static_cast<float>(i), .category = i % 3 == 0 ? "robots" : "others", .id = i};
        if (i % 5 != 0) {
            row.ticks = i;
        }
        std::vector<CellValue> cells(kUserColumns.size());
        if (i % 7 != 0) {
            cells = {std::int64_t{i}, std::string(static_cast<std::size_t>(i % 11), 'x'), i % 2 == 0, 0.5 * i};
        }
        file.append(row, cells);
    }
}

/// Bytes of a complete file of 1000 rows, saved after each `rows_between_saves` of them.
std::string bytes_when_saved(std::string const& path, std::int64_t flush_row_count, int rows_between_saves) {
    DataFile file({.path = path, .user_columns = kUserColumns, .flush_row_count = flush_row_count});
    for (int i = 0; i < 1000; ++i) {
        append_rows(file, i, 1);
        if (i % rows_between_saves == 0) {
            file.save();
        }
    }
    file.close();
    return bytes_of(path);
}

TEST_F(CompletedDataFile, HasTheSameBytesWhereverItWasSavedInBetween) {
    for (std::int64_t const flush_row_count : {1000000, 1000, 333, 8, 1}) {
        auto const never = bytes_when_saved(path("a.feather"), flush_row_count, 5000);
        for (int const rows : {1, 7, 100, 333, 1000}) {
            EXPECT_EQ(bytes_when_saved(path("a.feather"), flush_row_count, rows), never)
                << flush_row_count << ", " << rows;
        }
    }
}

/// Many rows fill memory long before the clock asks for a save.
TEST_F(UnfinishedDataFile, GetsManyRowsBeforeASaveIsDue) {
    DataFile file({.path = path("a.feather"), .user_columns = kUserColumns});
    constexpr int kRobots = 1000;
    std::vector<ObjectRow> rows(kRobots);
    std::vector<CellValue> const cells(kRobots * kUserColumns.size());
    std::int64_t written = 0;
    for (int moment = 0; moment < 200; ++moment) {
        for (ObjectRow& row : rows) {
            row = {.time_s = 0.1 * moment, .category = "robots"};
        }
        file.append(rows, cells);
        file.save_if_due();
        written += kRobots;
        std::int64_t const saved = read_unfinished(path("a.feather"))->num_rows();
        EXPECT_EQ(saved % kRobots, 0) << "rows of whole moments";
        EXPECT_LE(written - saved, 66'000);
    }
}

TEST_F(UnfinishedDataFile, HoldsAllRowsThatWereSaved) {
    DataFile file(
        {.path = path("a.feather"), .user_columns = kUserColumns, .metadata = {{"configuration", "seed: 1"}}});
    EXPECT_EQ(read_unfinished(path("a.feather"))->num_rows(), 0);
    append_rows(file, 0, 10);
    file.save();
    append_rows(file, 10, 20);
    file.save();
    append_rows(file, 30, 5);

    auto const table = read_unfinished(path("a.feather"));
    EXPECT_EQ(table->num_rows(), 30);
    EXPECT_EQ(table->schema()->metadata()->Get("configuration").ValueOrDie(), "seed: 1");
    EXPECT_TRUE(table->schema()->metadata()->Contains("incomplete"));
    file.close();
    auto const complete = read_back(path("a.feather")).table;
    EXPECT_FALSE(complete->schema()->metadata()->Contains("incomplete"));
    EXPECT_TRUE(complete->Slice(0, 30)->Equals(*table->ReplaceSchemaMetadata(complete->schema()->metadata())));
}

TEST_F(UnfinishedDataFile, HoldsRowsOfManyFullBatches) {
    DataFile file({.path = path("a.feather"), .user_columns = kUserColumns, .flush_row_count = 3});
    append_rows(file, 0, 100);
    file.save();
    EXPECT_EQ(read_unfinished(path("a.feather"))->num_rows(), 100);
}

TEST_F(UnfinishedDataFile, IsSavedByItselfSoonAfterItsFirstRows) {
    DataFile file({.path = path("a.feather"), .user_columns = kUserColumns});
    append_rows(file, 0, 10);
    for (int i = 0; i < 1000 && read_unfinished(path("a.feather"))->num_rows() == 0; ++i) {
        usleep(1000);
        file.save_if_due();
    }
    EXPECT_EQ(read_unfinished(path("a.feather"))->num_rows(), 10);
}

TEST_F(UnfinishedDataFile, CanBeReadUpToAnyByteWhereItIsCutOff) {
    DataFile file({.path = path("a.feather"), .user_columns = kUserColumns});
    auto const head = bytes_of(path("a.feather")).size();
    for (int i = 0; i < 5; ++i) {
        append_rows(file, 10 * i, 10);
        file.save();
    }
    auto const bytes = bytes_of(path("a.feather"));
    std::int64_t rows_before = 0;
    for (std::size_t size = head; size < bytes.size() + 13; size += 13) {
        std::ofstream(path("cut"), std::ios::binary) << bytes.substr(0, size);
        auto const rows = read_unfinished(path("cut"))->num_rows();
        EXPECT_EQ(rows % 10, 0);
        EXPECT_GE(rows, rows_before);
        rows_before = rows;
    }
    EXPECT_EQ(rows_before, 50);
}

TEST_F(UnfinishedDataFile, IsSavedByItselfBeforeTooManyRowsWait) {
    DataFile file({.path = path("a.feather"), .flush_row_count = 1 << 18});
    for (int i = 0; i < 1 << 20; ++i) {
        file.append({.category = "robots", .id = i}, {});
    }
    EXPECT_EQ(read_unfinished(path("a.feather"))->num_rows(), 1 << 20);
}

TEST_F(UnfinishedDataFile, IsAsBeforeAfterRowsThatDidNotFitAndGoesOnFromThere) {
    auto const schema = arrow::schema({arrow::field("number", arrow::int64())});
    auto const rows = [&schema](std::int64_t count) {
        arrow::Int64Builder numbers;
        for (std::int64_t i = 0; i < count; ++i) {
            EXPECT_TRUE(numbers.Append(i * i * 7919).ok());
        }
        return arrow::RecordBatch::Make(schema, count, {numbers.Finish().ValueOrDie()});
    };
    LockedFile locked(path("a.feather"));
    locked.keep();
    auto const file = UnfinishedFile::start(locked.descriptor(), schema).ValueOrDie();
    ASSERT_TRUE(file->append(*rows(10)).ok());
    auto const before = bytes_of(path("a.feather"));
    {
        FileSizeLimit const limit(before.size() + 1000);
        EXPECT_FALSE(file->append(*rows(100000)).ok());
    }
    EXPECT_EQ(bytes_of(path("a.feather")), before);
    EXPECT_FALSE(file->was_changed_by_others());
    ASSERT_TRUE(file->append(*rows(5)).ok());
    EXPECT_EQ(read_unfinished(path("a.feather"))->num_rows(), 15);
}

TEST_F(UnfinishedDataFile, IsNotTouchedByAChildOfTheProcess) {
    DataFile file({.path = path("a.feather"), .user_columns = kUserColumns, .flush_row_count = 20});
    append_rows(file, 0, 10);
    file.save();
    pid_t const child = fork();
    if (child == 0) {
        append_rows(file, 10, 50);
        file.save();
        file.close();
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(read_unfinished(path("a.feather"))->num_rows(), 10);
    append_rows(file, 10, 20);
    file.close();
    EXPECT_EQ(read_back(path("a.feather")).table->num_rows(), 30);
    EXPECT_EQ(files_in_folder(), std::vector<std::string>{"a.feather"});
}

TEST_F(UnfinishedDataFile, ThatWasReservedInVainIsNotThere) {
    { auto const reserved = DataFile::reserve(path("a.feather")); }
    EXPECT_TRUE(files_in_folder().empty());
}

TEST_F(UnfinishedDataFile, LeavesWhatStandsInAReservedFile) {
    std::ofstream(path("a.feather")) << "older data";
    { auto const reserved = DataFile::reserve(path("a.feather")); }
    EXPECT_EQ(bytes_of(path("a.feather")), "older data");
}

// ---- in the place of the unfinished file ----------------------------------------------------------------------------

void write_rows(std::string const& path) {
    DataFile file({.path = path, .user_columns = kUserColumns, .flush_row_count = 20});
    append_rows(file, 0, 50);
    file.close();
}

/// Bytes of a data file with metadata such as a run gives it.
std::string bytes_of_a_run(std::string const& path) {
    {
        DataFile file({.path = path, .user_columns = kUserColumns, .metadata = {{"program_version", "1"}}});
        append_rows(file, 0, 50);
        file.close();
    }
    auto bytes = bytes_of(path);
    std::filesystem::remove(path);
    return bytes;
}

TEST_F(CompletedDataFile, StandsAloneInItsFolder) {
    auto const bytes = bytes_of_a_run(path("b.feather"));
    for (auto const size : {std::size_t{0}, bytes.size() - 1, bytes.size() - 8}) {  // of runs that were killed
        std::ofstream(path("a.feather.pogosim-new"), std::ios::binary) << bytes.substr(0, size);
        write_rows(path("a.feather"));
        EXPECT_EQ(files_in_folder(), std::vector<std::string>{"a.feather"}) << size;
    }
}

TEST_F(CompletedDataFile, IsWrittenWithoutHarmToFilesOfTheNameThatItHasOnItsWay) {
    auto const complete = bytes_of_a_run(path("b.feather"));
    auto const of_no_run = [this] {
        write_rows(path("b.feather"));  // no metadata of a run
        auto const bytes = bytes_of(path("b.feather"));
        std::filesystem::remove(path("b.feather"));
        return bytes.substr(0, bytes.size() - 1);
    }();
    std::string const other = path("a.feather.pogosim-new");
    for (auto const& bytes :
         {std::string("seed: 1\n"), complete, of_no_run, std::string("ARROW1\0\0", 8), complete.substr(0, 40)}) {
        std::ofstream(other, std::ios::binary) << bytes;
        write_rows(path("a.feather"));
        EXPECT_EQ(bytes_of(other), bytes);
        EXPECT_EQ(files_in_folder(), (std::vector<std::string>{"a.feather", "a.feather.pogosim-new"}));
        EXPECT_EQ(read_back(path("a.feather")).table->num_rows(), 50);
    }
}

TEST_F(CompletedDataFile, IsWrittenWithoutHarmToACompleteParquetFileOfThatName) {
    std::string const other = path("a.feather.pogosim-new");
    std::ofstream(other, std::ios::binary) << "PAR1 rows PAR1";
    write_rows(path("a.feather"));
    EXPECT_EQ(bytes_of(other), "PAR1 rows PAR1");
    std::ofstream(other, std::ios::binary) << "PAR1 rows";  // of a run that was killed
    write_rows(path("a.feather"));
    EXPECT_EQ(files_in_folder(), std::vector<std::string>{"a.feather"});
}

TEST_F(CompletedDataFile, IsWrittenWithoutHarmToTheFileOfAnotherRun) {
    DataFile other({.path = path("a.feather.pogosim-new"), .metadata = {{"program_version", "1"}}});
    write_rows(path("a.feather"));
    other.append({.category = "robots"}, {});
    other.close();
    EXPECT_EQ(read_back(path("a.feather.pogosim-new")).table->num_rows(), 1);
}

TEST_F(CompletedDataFile, IsWrittenWithoutHarmToOneThatAnotherRunHasOnItsWay) {
    auto const bytes = bytes_of_a_run(path("b.feather"));
    for (auto const size : {std::size_t{0}, bytes.size() - 1}) {
        std::ofstream(path("a.feather.pogosim-new"), std::ios::binary) << bytes.substr(0, size);
        auto const of_another_run = DataFile::reserve(path("a.feather.pogosim-new"));
        write_rows(path("a.feather"));
        EXPECT_TRUE(of_another_run.is_still_there());
        EXPECT_EQ(bytes_of(path("a.feather.pogosim-new")), bytes.substr(0, size));
    }
}

TEST_F(CompletedDataFile, IsWrittenWithoutHarmToTheFileOfARunThatWasKilled) {
    {
        DataFile other({.path = path("b"), .metadata = {{"program_version", "1"}}});
        other.append({.category = "robots"}, {});
        other.save();
        std::filesystem::copy(path("b"), path("a.feather.pogosim-new"));
    }
    write_rows(path("a.feather"));
    EXPECT_EQ(read_unfinished(path("a.feather.pogosim-new"))->num_rows(), 1);
}

TEST_F(CompletedDataFile, IsWrittenWithoutHarmToLinksOfTheNameThatItHasOnItsWay) {
    std::ofstream(path("b")).close();
    std::filesystem::create_symlink(path("b"), path("a.feather.pogosim-new"));
    std::filesystem::create_hard_link(path("b"), path("c.feather.pogosim-new"));
    write_rows(path("a.feather"));
    write_rows(path("c.feather"));
    EXPECT_TRUE(std::filesystem::is_symlink(path("a.feather.pogosim-new")));
    EXPECT_TRUE(std::filesystem::equivalent(path("b"), path("c.feather.pogosim-new")));
}

TEST_F(CompletedDataFile, StandsWhereASymbolicLinkLeads) {
    std::filesystem::create_directory(path("elsewhere"));
    std::filesystem::create_symlink(path("elsewhere/b.feather"), path("a.feather"));
    for (int run = 0; run < 2; ++run) {  // the first one makes the file
        write_rows(path("a.feather"));
        EXPECT_TRUE(std::filesystem::is_symlink(path("a.feather")));
        EXPECT_EQ(read_back(path("elsewhere/b.feather")).table->num_rows(), 50);
    }
}

TEST_F(CompletedDataFile, StandsUnderAllNamesOfTheFile) {
    std::ofstream(path("a.feather")) << "older data, longer than the new: " << std::string(100000, 'x');
    std::filesystem::create_hard_link(path("a.feather"), path("b.feather"));
    write_rows(path("a.feather"));
    EXPECT_EQ(read_back(path("b.feather")).table->num_rows(), 50);
    EXPECT_TRUE(std::filesystem::equivalent(path("a.feather"), path("b.feather")));
    EXPECT_EQ(files_in_folder(), (std::vector<std::string>{"a.feather", "b.feather"}));
}

TEST_F(CompletedDataFile, EndsWhereItsRowsDoUnderAllNamesOfTheFile) {
    auto const write = [this](std::string const& name) {
        DataFile file({.path = path(name)});
        for (int i = 0; i < 200; ++i) {
            file.append({.category = "robots", .id = i}, {});
            file.save();  // the unfinished file becomes larger than the complete one
        }
        file.close();
    };
    write("alone.feather");
    std::ofstream(path("a.feather")).close();
    std::filesystem::create_hard_link(path("a.feather"), path("b.feather"));
    write("a.feather");
    EXPECT_EQ(bytes_of(path("b.feather")), bytes_of(path("alone.feather")));
}

TEST_F(CompletedDataFile, KeepsTheOwnerAndTheGroupOfTheFile) {
    bool const is_root = geteuid() == 0;  // only root can give files away
    for (auto const& [owner, group] : {std::pair<uid_t, gid_t>{12345, 0}, {0, 12345}}) {
        std::ofstream(path("a.feather")) << "older data";
        if (is_root) {
            ASSERT_EQ(chown(path("a.feather").c_str(), owner, group), 0);
        }
        write_rows(path("a.feather"));
        struct stat after = {};
        ASSERT_EQ(stat(path("a.feather").c_str(), &after), 0);
        EXPECT_EQ(after.st_uid, is_root ? owner : geteuid());
        EXPECT_EQ(after.st_gid, is_root ? group : getegid());
        EXPECT_EQ(read_back(path("a.feather")).table->num_rows(), 50);
        std::filesystem::remove(path("a.feather"));
    }
}

TEST_F(CompletedDataFile, KeepsThePermissionsOfTheFile) {
    std::ofstream(path("a.feather")) << "older data";
    chmod(path("a.feather").c_str(), 0640);
    write_rows(path("a.feather"));
    struct stat now = {};
    ASSERT_EQ(stat(path("a.feather").c_str(), &now), 0);
    EXPECT_EQ(now.st_mode & 0777, 0640U);
}

TEST_F(CompletedDataFile, IsWrittenEvenWhereNoOtherFileCanStandBesideIt) {
    std::string const name = path(std::string(250, 'a'));  // all names beside it are too long
    EnvironmentVariable const temporary("TMPDIR", path("tmp"));
    std::filesystem::create_directory(path("tmp"));
    DataFile file({.path = name, .user_columns = kUserColumns, .flush_row_count = 20});
    append_rows(file, 0, 50);
    EXPECT_TRUE(std::filesystem::is_empty(path("tmp")));  // nothing that a killed run could leave there
    file.close();
    EXPECT_EQ(read_back(name).table->num_rows(), 50);
    EXPECT_TRUE(std::filesystem::is_empty(path("tmp")));
}

}  // namespace
}  // namespace pogosim
