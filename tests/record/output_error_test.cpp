// Every failure to write is reported, with the path and the system's reason.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
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

using OutputFailure = FileTest;

/// Message of the OutputError that the action gives; empty if it gives none.
std::string output_error(std::function<void()> const& action) {
    try {
        action();
    } catch (OutputError const& error) {
        return error.what();
    }
    return {};
}

std::string open_error(std::string const& path) {
    return output_error([&path] { DataFile const file({.path = path}); });
}

void write_one_row(std::string const& path) {
    DataFile file({.path = path});
    file.append({.category = "robots"}, {});
    file.close();
}

#if defined(__linux__) && !defined(POGOSIM_SANITIZED)

/// Arrow's other allocators keep what was freed, and get along without new memory for long.
[[maybe_unused]] int const plain_allocator = setenv("ARROW_DEFAULT_MEMORY_POOL", "system", 1);

/// This process gets no more than `bytes` of memory from now on.
class AddressSpaceLimit {
public:
    explicit AddressSpaceLimit(std::size_t bytes) {
        std::ifstream sizes("/proc/self/statm");
        std::size_t pages = 0;
        sizes >> pages;
        getrlimit(RLIMIT_AS, &before_);
        rlimit const limit{.rlim_cur = pages * static_cast<std::size_t>(getpagesize()) + bytes,
                           .rlim_max = before_.rlim_max};
        setrlimit(RLIMIT_AS, &limit);
    }
    ~AddressSpaceLimit() { setrlimit(RLIMIT_AS, &before_); }
    AddressSpaceLimit(AddressSpaceLimit const&) = delete;
    AddressSpaceLimit& operator=(AddressSpaceLimit const&) = delete;

private:
    rlimit before_{};
};

#endif

void expect_says(std::string const& message, std::vector<std::string> const& parts) {
    for (auto const& part : parts) {
        EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is missing in: " << message;
    }
}

TEST_F(OutputFailure, PathThatIsAFolderIsRefusedAtOnce) {
    std::filesystem::create_directory(path("folder"));
    expect_says(open_error(path("folder")), {path("folder"), "data_filename", "Is a directory"});
}

TEST_F(OutputFailure, PathBelowAFileIsRefusedAtOnce) {
    std::ofstream(path("file")) << "x";
    expect_says(open_error(path("file/a.feather")), {path("file/a.feather"), "Not a directory"});
    expect_says(open_error(path("file/deeper/a.feather")), {path("file/deeper/a.feather"), "cannot make the folder"});
}

TEST_F(OutputFailure, EmptyPathIsRefusedAtOnce) {
    expect_says(open_error(""), {"cannot write the data file ''", "No such file"});
}

TEST_F(OutputFailure, PipeIsRefusedAtOnceInsteadOfWaitingForItsReader) {
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    expect_says(open_error(path("pipe")), {path("pipe"), "a pipe", "not a file", "enable_data_logging: false"});
}

TEST_F(OutputFailure, DeviceThatTakesEverythingIsRefusedAtOnce) {
    expect_says(open_error("/dev/null"), {"/dev/null", "a device", "not a file"});
}

TEST_F(OutputFailure, FullDiskIsRefusedAtOnce) {
    expect_says(open_error("/dev/full"), {"/dev/full", "No space left on device"});
}

/// Writes rows until that fails. Returns the message.
std::string fill_the_disk(DataFileOptions const& options) {
    DataFile file(options);
    std::string const message = output_error([&file] {
        for (int i = 0; i < 1000000; ++i) {
            file.append({.time_s = static_cast<float>(i), .category = "robots", .id = i % 977}, {});
            if (i % 1000 == 999) {
                file.save();
            }
        }
        file.close();
    });
    EXPECT_EQ(output_error([&file] { file.close(); }), "");  // said once
    return message;
}

TEST_F(OutputFailure, DiskThatFillsUpLeavesTheRowsUpToThereAndSaysHowToHaveThem) {
    FileSizeLimit const limit(100000);
    std::string const message = fill_the_disk({.path = path("a.feather")});
    auto const rows = read_unfinished(path("a.feather"))->num_rows();
    EXPECT_GT(rows, 1000);
    expect_says(message, {"File too large", fmt::format("contains the rows up to t = {}.0000 s", rows - 1),
                          "pogosim-recover '" + path("a.feather") + "'"});
    EXPECT_EQ(files_in_folder(), std::vector<std::string>{"a.feather"});
}

TEST_F(OutputFailure, DiskTooSmallForTheFirstRowsTogetherHoldsThoseOfTheFirstTimes) {
    FileSizeLimit const limit(100000);
    DataFile file({.path = path("a.feather")});
    for (int i = 0; i < 100000; ++i) {
        file.append({.time_s = static_cast<float>(i / 7), .category = "robots", .id = i % 977}, {});
    }
    std::string const message = output_error([&file] { file.save(); });
    auto const table = read_unfinished(path("a.feather"));
    EXPECT_GT(std::filesystem::file_size(path("a.feather")), 90000U);
    EXPECT_EQ(table->num_rows() % 7, 0);  // rows of whole moments
    expect_says(message, {"File too large", fmt::format("up to t = {}.0000 s", table->num_rows() / 7 - 1)});
}

TEST_F(OutputFailure, DiskTooSmallForTheRowsOfManyBatchesHoldsThoseOfTheFirstTimes) {
    FileSizeLimit const limit(100000);
    DataFile file({.path = path("a.feather"), .flush_row_count = 1000});
    std::string const message = output_error([&file] {
        for (int i = 0; i < 100000; ++i) {
            file.append({.time_s = static_cast<float>(i / 7), .category = "robots", .id = i % 977}, {});
        }
        file.save();
    });
    auto const rows = read_unfinished(path("a.feather"))->num_rows();
    EXPECT_GT(rows, 1000);
    expect_says(message, {"File too large", fmt::format("up to t = {}.0000 s{}", (rows - 1) / 7,
                                                        rows % 7 == 0 ? ";" : ", and not all of that time;")});
    EXPECT_EQ(files_in_folder(), std::vector<std::string>{"a.feather"});  // the room of the complete file is free again
}

TEST_F(OutputFailure, DiskThatFillsUpWithinTheRowsOfATimeSaysThatNotAllOfThatTimeAreThere) {
    std::vector<std::string> endings;
    for (int limit_bytes = 100000; limit_bytes < 104000; limit_bytes += 500) {
        FileSizeLimit const limit(static_cast<rlim_t>(limit_bytes));
        std::string const name = path(fmt::format("{}.feather", limit_bytes));
        DataFile file({.path = name, .flush_row_count = 1});  // each row is a piece of its own
        std::string const message = output_error([&file] {
            for (int i = 0; i < 100000; ++i) {
                file.append({.time_s = static_cast<float>(i / 7), .category = "robots", .id = i % 977}, {});
                if (i % 7 == 6) {
                    file.save();
                }
            }
        });
        auto const rows = read_unfinished(name)->num_rows();
        ASSERT_GT(rows, 7);
        endings.emplace_back(rows % 7 == 0 ? ";" : ", and not all of that time;");
        expect_says(message, {fmt::format("up to t = {}.0000 s{}", (rows - 1) / 7, endings.back())});
    }
    EXPECT_NE(std::ranges::count(endings, ";"), static_cast<std::ptrdiff_t>(endings.size()));
}

TEST_F(OutputFailure, DiskThatFillsUpWithTheCompleteFileLeavesTheUnfinishedOne) {
    FileSizeLimit const limit(100000);
    DataFileOptions options{.path = path("a.feather"), .flush_row_count = 10};  // its many batches need more room
    expect_says(fill_the_disk(options), {"File too large", "pogosim-recover"});
    EXPECT_GT(read_unfinished(path("a.feather"))->num_rows(), 0);
    EXPECT_EQ(files_in_folder(), std::vector<std::string>{"a.feather"});
}

TEST_F(OutputFailure, DiskWithoutRoomForAddedMetadataHoldsAllRowsWithoutThem) {
    // Rows that compress well, in batches that are read again: only metadata that do not compress need room.
    DataFile file({.path = path("a.feather"), .flush_row_count = 10, .metadata = {{"program_version", "v1.2.3"}}});
    for (int i = 0; i < 50; ++i) {
        file.append({.category = "robots"}, {});
    }
    file.add_metadata("touched", std::string(200000, 'x'));
    FileSizeLimit const limit(100000);
    file.close();
    auto const data = read_back(path("a.feather"));
    EXPECT_EQ(data.table->num_rows(), 50);
    EXPECT_FALSE(data.table->schema()->metadata()->Contains("touched"));
    EXPECT_EQ(files_in_folder(), std::vector<std::string>{"a.feather"});
}

TEST_F(OutputFailure, FileRemovedDuringTheRunIsMadeAgain) {
    DataFile file({.path = path("a.feather")});
    file.append({.category = "robots"}, {});
    std::filesystem::remove(path("a.feather"));
    file.close();
    EXPECT_EQ(read_back(path("a.feather")).table->num_rows(), 1);
}

TEST_F(OutputFailure, FolderRemovedDuringTheRunIsAnErrorAndTheRowsAreInTheFolderForTemporaryFiles) {
    EnvironmentVariable const temporary("TMPDIR", path("tmp"));
    std::filesystem::create_directory(path("tmp"));
    DataFile file({.path = path("folder/a.feather")});
    file.append({.category = "robots"}, {});
    std::filesystem::remove_all(path("folder"));
    expect_says(output_error([&file] { file.close(); }), {path("folder/a.feather"), "No such file or directory",
                                                          "The rows of this run are in '" + path("tmp/")});
    std::filesystem::directory_iterator const kept(path("tmp"));
    EXPECT_EQ(read_back(kept->path()).table->num_rows(), 1);
}

TEST_F(OutputFailure, FileThatAnotherProgramWroteOverIsNoticedAndTheRowsAreBesideIt) {
    DataFile file({.path = path("a.feather")});
    file.append({.category = "robots"}, {});
    std::ofstream(path("a.feather"), std::ios::app) << std::string(100000, 'x');
    expect_says(output_error([&file] { file.close(); }),
                {path("a.feather"), "did another program change it?", "'" + path("a.feather.pogosim-kept") + "'"});
    EXPECT_EQ(read_back(path("a.feather.pogosim-kept")).table->num_rows(), 1);
    EXPECT_EQ(files_in_folder(), (std::vector<std::string>{"a.feather", "a.feather.pogosim-kept"}));
}

TEST_F(OutputFailure, RowsThatStandBesideTheFileStayThereWhenOtherRunsWriteIt) {
    for (int run = 0; run < 2; ++run) {
        DataFile file({.path = path("a.feather"), .metadata = {{"program_version", "1"}}});
        file.append({.category = "robots", .id = run}, {});
        std::ofstream(path("a.feather"), std::ios::app) << std::string(100000, 'x');
        EXPECT_NE(output_error([&file] { file.close(); }), "");
    }
    write_one_row(path("a.feather"));
    EXPECT_EQ(files_in_folder(),
              (std::vector<std::string>{"a.feather", "a.feather.pogosim-kept", "a.feather.pogosim-kept-2"}));
    EXPECT_EQ(read_back(path("a.feather.pogosim-kept")).text("robot_id", 0), "0");
    EXPECT_EQ(read_back(path("a.feather.pogosim-kept-2")).text("robot_id", 0), "1");
}

TEST_F(OutputFailure, FileThatAnotherProgramPutThereIsLeftAlone) {
    DataFile file({.path = path("a.feather")});
    file.append({.category = "robots"}, {});
    std::ofstream(path("b")) << "something else";
    std::filesystem::rename(path("b"), path("a.feather"));
    expect_says(output_error([&file] { file.close(); }), {"another program replaced it", "a.feather.pogosim-kept"});
    EXPECT_EQ(bytes_of(path("a.feather")), "something else");
    EXPECT_EQ(read_back(path("a.feather.pogosim-kept")).table->num_rows(), 1);
}

TEST_F(OutputFailure, RowsOfACsvFileThatStandBesideItHaveTheirMetadata) {
    DataFile file({.path = path("a.csv"), .metadata = {{"program_version", "1"}, {"configuration", "seed: 17"}}});
    file.append({.category = "robots"}, {});
    std::ofstream(path("b")) << "something else";
    std::filesystem::rename(path("b"), path("a.csv"));
    expect_says(output_error([&file] { file.close(); }), {"another program replaced it", "a.csv.pogosim-kept"});
    EXPECT_EQ(files_in_folder(), (std::vector<std::string>{"a.csv", "a.csv.pogosim-kept", "a.csv.pogosim-kept.yaml"}));
    EXPECT_NE(bytes_of(path("a.csv.pogosim-kept")).find("robots"), std::string::npos);
    EXPECT_NE(bytes_of(path("a.csv.pogosim-kept.yaml")).find("seed: 17"), std::string::npos);
}

TEST_F(OutputFailure, FileThatAnotherRunWritesIsRefusedUntilThatOneHasEnded) {
    write_one_row(path("a.feather"));
    auto const before = bytes_of(path("a.feather"));
    {
        auto const reserved = DataFile::reserve(path("a.feather"));
        expect_says(open_error(path("a.feather")), {path("a.feather"), "data_filename", "in use by another run"});
        EXPECT_EQ(bytes_of(path("a.feather")), before);
    }
    {
        DataFile file({.path = path("a.feather")});
        std::filesystem::create_symlink(path("a.feather"), path("link"));
        expect_says(open_error(path("link")), {path("link"), "in use by another run"});
        file.close();
        expect_says(open_error(path("a.feather")), {"in use by another run"});  // the complete file, too
    }
    EXPECT_EQ(open_error(path("a.feather")), "");
}

#if defined(__linux__) && !defined(POGOSIM_SANITIZED)

TEST_F(OutputFailure, RowsThatFindNoMemoryTogetherAreSavedPieceByPiece) {
    constexpr int kRows = 3 * 100000;
    DataFileOptions options{.path = path("a.feather"), .flush_row_count = kRows / 3};
    for (int i = 0; i < 40; ++i) {
        options.user_columns.push_back({fmt::format("column {}", i), ColumnType::float64});
    }
    DataFile file(options);
    std::vector<CellValue> const cells(options.user_columns.size(), 0.5);
    for (int i = 0; i < kRows; ++i) {
        file.append({.time_s = static_cast<float>(i), .category = "robots", .id = i}, cells);
    }
    {
        AddressSpaceLimit const limit(30U << 20U);
        file.save();
    }
    EXPECT_EQ(read_unfinished(path("a.feather"))->num_rows(), kRows);
}

/// Allocates all memory that the process can still get, except `bytes_left`.
class MemoryHog {
public:
    explicit MemoryHog(std::size_t bytes_left) {
        blocks_.reserve(kMostBlocks);
        for (std::size_t size = 1U << 20U; size >= kLeast; size /= 2) {
            while (void* const block = blocks_.size() < kMostBlocks ? std::malloc(size) : nullptr) {
                blocks_.push_back(block);
            }
        }
        std::free(blocks_.front());  // of the largest ones
        blocks_.front() = std::malloc((1U << 20U) - bytes_left);
    }
    ~MemoryHog() {
        for (void* const block : blocks_) {
            std::free(block);
        }
    }
    MemoryHog(MemoryHog const&) = delete;
    MemoryHog& operator=(MemoryHog const&) = delete;

private:
    static constexpr std::size_t kMostBlocks = 100000;
    static constexpr std::size_t kLeast = 16;
    std::vector<void*> blocks_;
};

/// Whichever allocation of a save fails, large or small.
class MemoryOfASave : public OutputFailure, public testing::WithParamInterface<int> {};

TEST_P(MemoryOfASave, RunsShortWithoutALossOfRowsThatWereSaved) {
    constexpr int kRows = 20000;
    DataFileOptions options{.path = path("a.feather"), .flush_row_count = kRows};
    for (int i = 0; i < 40; ++i) {
        options.user_columns.push_back({fmt::format("column {}", i), ColumnType::float64});
    }
    DataFile file(options);
    std::vector<CellValue> const cells(options.user_columns.size(), 0.5);
    for (int i = 0; i < 3 * kRows + 10; ++i) {
        file.append({.time_s = static_cast<float>(i), .category = "robots", .id = i}, cells);
        if (i == 9) {
            file.save();
        }
    }
    std::string message;
    {
        AddressSpaceLimit const limit(static_cast<std::size_t>(GetParam()) << 10U);
        message = output_error([&file] { file.save(); });
    }
    auto const rows = read_unfinished(path("a.feather"))->num_rows();
    EXPECT_GE(rows, 10);
    if (message.empty()) {
        EXPECT_EQ(rows, 3 * kRows + 10);
    } else {
        expect_says(message, {"there is not enough memory for its rows", fmt::format("up to t = {}.0000 s", rows - 1)});
    }
}

TEST_F(OutputFailure, SmallestAllocationsThatFailAreReportedAsTooLittleMemory) {
    DataFile file({.path = path("a.feather")});
    for (int i = 0; i < 1000; ++i) {
        file.append({.time_s = static_cast<float>(i), .category = "robots", .id = i}, {});
    }
    std::string message;
    {
        AddressSpaceLimit const limit(4U << 20U);
        MemoryHog const hog(40000);
        message = output_error([&file] { file.save(); });
    }
    expect_says(message, {"there is not enough memory for its rows"});
}

INSTANTIATE_TEST_SUITE_P(Kilobytes, MemoryOfASave, testing::Range(0, 24000, 900));

#endif

}  // namespace
}  // namespace pogosim
