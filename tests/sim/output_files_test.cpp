// What is said of files that a run would write.
#include "sim/files_of_run.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

constexpr uid_t kNobody = 65534;
constexpr mode_t kMayRead = 0555;
constexpr mode_t kMayWrite = 0777;

/// Whether all is as expected, for a user who may not write everything.
bool is_told_as_expected(std::string const& folder) {
    if (geteuid() == 0 && setuid(kNobody) != 0) {
        return false;
    }
    std::string const denied = std::generic_category().message(EACCES);
    return why_not_writable(folder + "/mine").empty() && why_not_writable(folder + "/read_only") == denied &&
           why_not_writable(folder + "/new") == denied && why_not_writable(folder + "/new/folder/file") == denied &&
           why_not_writable(folder + "/open/new").empty();
}

TEST(OutputFiles, FileOrFolderInWhichNothingMayBeWrittenIsTold) {
    TemporaryFolder const temporary;
    std::string const folder = temporary / "folder";
    std::filesystem::create_directories(folder + "/open");
    std::ofstream(folder + "/mine") << "x";
    std::ofstream(folder + "/read_only") << "x";
    chmod((folder + "/mine").c_str(), kMayWrite);
    chmod((folder + "/read_only").c_str(), kMayRead);
    chmod((folder + "/open").c_str(), kMayWrite);
    chmod(folder.c_str(), kMayRead);
    chmod((temporary / "").c_str(), kMayWrite);
    EXPECT_EXIT(std::_Exit(is_told_as_expected(folder) ? 0 : 1), ::testing::ExitedWithCode(0), "");
    chmod(folder.c_str(), kMayWrite);
}

}  // namespace
}  // namespace pogosim
