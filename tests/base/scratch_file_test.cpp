#include "base/scratch_file.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

class ScratchFiles : public testing::Test {
protected:
    std::string path(char const* name = "scratch") const { return folder_ / name; }
    std::string made(char const* name = "scratch") const {
        std::ofstream(path(name)) << "on its way";
        return path(name);
    }
    static bool is_there(std::string const& path) { return std::filesystem::exists(path); }

private:
    TemporaryFolder folder_;
};

TEST_F(ScratchFiles, AreRemovedWithTheirObjects) {
    { ScratchFile const file(made()); }
    EXPECT_FALSE(is_there(path()));
}

TEST_F(ScratchFiles, AreRemovedOnceWhenTheProcessEndsEarly) {
    ScratchFile one(made("one"));
    ScratchFile const other(made("other"));
    one.release();
    remove_scratch_files();
    EXPECT_TRUE(is_there(path("one"))) << "it has become the user's";
    EXPECT_FALSE(is_there(path("other")));
    made("other");
    remove_scratch_files();
    EXPECT_TRUE(is_there(path("other"))) << "of the user";
}

/// The scratch files of two runs are independent.
TEST_F(ScratchFiles, AreRemovedInAnyNumberAndOrder) {
    std::vector<std::unique_ptr<ScratchFile>> files;
    for (int i = 0; i < 100; ++i) {
        files.push_back(std::make_unique<ScratchFile>(made(std::to_string(i).c_str())));
    }
    files[3].reset();
    EXPECT_FALSE(is_there(path("3")));
    EXPECT_TRUE(is_there(path("2")) && is_there(path("4")) && is_there(path("99")));
    files.clear();
    EXPECT_FALSE(is_there(path("2")) || is_there(path("99")));
}

TEST_F(ScratchFiles, AreNotRemovedByAChildOfTheProcess) {
    {
        ScratchFile file(made());
        pid_t const child = fork();
        if (child == 0) {
            remove_scratch_files();
            file.remove();
            _exit(0);
        }
        waitpid(child, nullptr, 0);
        EXPECT_TRUE(is_there(path()));
    }
    EXPECT_FALSE(is_there(path()));
}

}  // namespace
}  // namespace pogosim
