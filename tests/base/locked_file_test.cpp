// Two runs that write one file, and changes of the file between a check and the action that follows it.
#include "base/locked_file.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

#include "support/temporary_folder.hpp"

namespace {

std::function<void()> before_lock;  // what another program does, once, just before the next lock is taken

}  // namespace

/// Replaces the system's function of that name.
extern "C" int flock(int descriptor, int operation) noexcept {
    if (auto const other = std::exchange(before_lock, nullptr)) {
        other();
    }
    static auto* const real = reinterpret_cast<int (*)(int, int)>(dlsym(RTLD_NEXT, "flock"));
    return real(descriptor, operation);
}

namespace pogosim {
namespace {

class LockedFiles : public testing::Test {
protected:
    std::string path() const { return folder_ / "file"; }

    /// Another run takes the lock of the file; returns its descriptor.
    int lock_as_another_run() const {
        int const descriptor = open(path().c_str(), O_RDWR | O_CLOEXEC);
        EXPECT_EQ(flock(descriptor, LOCK_EX | LOCK_NB), 0);
        return descriptor;
    }

    bool another_run_is_refused() const {
        try {
            LockedFile const other(path());
        } catch (FileError const&) {
            return true;
        }
        return false;
    }

    TemporaryFolder folder_;
};

TEST_F(LockedFiles, FileIsRefusedToASecondRunUntilTheFirstHasEnded) {
    {
        LockedFile const file(path());
        EXPECT_TRUE(another_run_is_refused());
        EXPECT_TRUE(std::filesystem::exists(path()));
    }
    EXPECT_FALSE(another_run_is_refused());
}

TEST_F(LockedFiles, FileThatWasMadeInVainIsRemovedAndOneThatWasThereOrIsKeptStays) {
    { LockedFile const file(path()); }
    EXPECT_FALSE(std::filesystem::exists(path()));
    {
        LockedFile file(path());
        file.keep();
    }
    EXPECT_TRUE(std::filesystem::exists(path()));
    { LockedFile const file(path()); }
    EXPECT_TRUE(std::filesystem::exists(path()));
}

TEST_F(LockedFiles, FileThatAnotherRunLocksJustAfterItWasMadeIsLeftToThatRun) {
    int descriptor = -1;
    before_lock = [&] { descriptor = lock_as_another_run(); };
    EXPECT_TRUE(another_run_is_refused());
    ASSERT_GE(descriptor, 0);
    EXPECT_TRUE(std::filesystem::exists(path()));
    close(descriptor);
}

TEST_F(LockedFiles, FileThatIsReplacedJustBeforeItsLockIsOpenedAnew) {
    before_lock = [this] {
        std::ofstream(folder_ / "other") << "of another run";
        std::filesystem::rename(folder_ / "other", path());
    };
    {
        LockedFile const file(path());
        EXPECT_TRUE(file.is_still_there());
        EXPECT_TRUE(another_run_is_refused());
    }
    EXPECT_EQ(std::filesystem::file_size(path()), 14U);
}

TEST_F(LockedFiles, FileThatIsRemovedJustBeforeItsLockIsMadeAgain) {
    before_lock = [this] { std::filesystem::remove(path()); };
    LockedFile const file(path());
    EXPECT_TRUE(file.is_still_there());
    EXPECT_TRUE(another_run_is_refused());
}

TEST_F(LockedFiles, ChildOfTheProcessNeitherUnlocksNorRemovesIt) {
    LockedFile file(path());
    pid_t const child = fork();
    if (child == 0) {
        { LockedFile const own = std::move(file); }
        _exit(0);
    }
    waitpid(child, nullptr, 0);
    EXPECT_TRUE(std::filesystem::exists(path()));
    EXPECT_TRUE(another_run_is_refused());
}

TEST_F(LockedFiles, FileOfAnotherThatStandsInItsPlaceIsNotRemoved) {
    {
        LockedFile const file(path());
        std::filesystem::remove(path());
        std::ofstream(path()) << "other";
    }
    EXPECT_TRUE(std::filesystem::exists(path()));
}

}  // namespace
}  // namespace pogosim
