#include "base/scratch_file.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

class ScratchFile : public testing::Test {
protected:
    ScratchFile() {
        std::ofstream(path()) << "on its way";
        remember_scratch_file(path());
    }
    ~ScratchFile() override { forget_scratch_file(); }

    std::string path() const { return folder_ / "scratch"; }

private:
    TemporaryFolder folder_;
};

TEST_F(ScratchFile, IsRemovedOnceByTheProcessThatMadeIt) {
    remove_scratch_file();
    EXPECT_FALSE(std::filesystem::exists(path()));
    std::ofstream(path()) << "of the user";
    remove_scratch_file();
    EXPECT_TRUE(std::filesystem::exists(path()));
}

TEST_F(ScratchFile, ThatHasBecomeTheUsersStays) {
    forget_scratch_file();
    remove_scratch_file();
    EXPECT_TRUE(std::filesystem::exists(path()));
}

TEST_F(ScratchFile, IsNotRemovedByAChildOfTheProcess) {
    pid_t const child = fork();
    if (child == 0) {
        remove_scratch_file();
        _exit(0);
    }
    waitpid(child, nullptr, 0);
    EXPECT_TRUE(std::filesystem::exists(path()));
    remove_scratch_file();
    EXPECT_FALSE(std::filesystem::exists(path()));
}

}  // namespace
}  // namespace pogosim
