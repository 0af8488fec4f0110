// What goes wrong between the simulator and the disk is said, with the path and the system's reason.
#include <sys/stat.h>

#include <functional>

#include "base/error.hpp"
#include "record/data_file.hpp"
#include "scratch.hpp"

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

TEST_F(OutputFailure, DeviceThatTakesEverythingIsAnErrorOnClosing) {
    DataFile file({.path = "/dev/null"});
    file.append({.category = "robots"}, {});
    expect_says(output_error([&file] { file.close(); }), {"/dev/null", "a device", "not a file"});
}

TEST_F(OutputFailure, FullDiskIsAnErrorOnClosing) {
    DataFile file({.path = "/dev/full"});
    file.append({.category = "robots"}, {});
    expect_says(output_error([&file] { file.close(); }), {"/dev/full", "No space left on device"});
    EXPECT_EQ(output_error([&file] { file.close(); }), "");  // said once
}

TEST_F(OutputFailure, FullDiskIsAnErrorForTheRowThatFillsABatch) {
    DataFile file({.path = "/dev/full", .flush_row_count = 3});
    file.append({.category = "robots"}, {});
    file.append({.category = "robots"}, {});
    expect_says(output_error([&file] { file.append({.category = "robots"}, {}); }), {"No space left on device"});
}

TEST_F(OutputFailure, FileWithoutRowsOnAFullDiskIsAnErrorToo) {
    DataFile file({.path = "/dev/full"});
    expect_says(output_error([&file] { file.close(); }), {"No space left on device"});
}

TEST_F(OutputFailure, FileRemovedDuringTheRunIsNoticed) {
    DataFile file({.path = path("a.feather")});
    std::filesystem::remove(path("a.feather"));
    expect_says(output_error([&file] { file.close(); }), {path("a.feather"), "did another program remove it?"});
}

TEST_F(OutputFailure, FileThatAnotherProgramWroteOverIsNoticed) {
    DataFile file({.path = path("a.feather")});
    file.append({.category = "robots"}, {});
    std::ofstream(path("a.feather"), std::ios::app) << std::string(100000, 'x');
    expect_says(output_error([&file] { file.close(); }), {path("a.feather"), "did another program change it?"});
}

}  // namespace
}  // namespace pogosim
