// Names of frames from the pattern of a configuration.
#include "render/frame_names.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

TEST(FrameNames, TimeTakesThePlaceOfTheField) {
    EXPECT_EQ(FrameNames("frames/f{:010.4f}.png").at(1.0), "frames/f00001.0000.png");
    EXPECT_EQ(FrameNames("f{:.0f}").at(12.0), "f12");
    EXPECT_EQ(FrameNames("{:g}/f.png").at(0.5), "0.5/f.png");
}

TEST(FrameNames, TimesOfStepsAreShownAsTheyWereMeant) {
    EXPECT_EQ(FrameNames("f{}.png").at(3 * 0.1), "f0.3.png");
}

TEST(FrameNames, FolderIsKnownUnlessItDependsOnTheTime) {
    EXPECT_EQ(FrameNames("frames/f{}.png").folder(), "frames");
    EXPECT_EQ(FrameNames("/a/b/{}").folder(), "/a/b");
    EXPECT_EQ(FrameNames("f{}.png").folder(), ".");
    EXPECT_EQ(FrameNames("f{}/a.png").folder(), std::nullopt);
}

class FrameNamesAndFiles : public testing::Test {
protected:
    void SetUp() override { std::ofstream(folder_ / "f00001.5000.png") << "a file"; }

    TemporaryFolder folder_;
    FrameNames names_{folder_ / "f{:010.4f}.png"};
};

TEST_F(FrameNamesAndFiles, FileThatAFrameWouldReplaceIsRecognised) {
    EXPECT_TRUE(names_.may_be(folder_ / "f00001.5000.png"));
    EXPECT_TRUE(names_.may_be(folder_ / "f00002.0000.png"));  // need not exist
    EXPECT_TRUE(names_.may_be(folder_ / "../" + folder_.path().filename().string() + "/f00001.5000.png"));
}

TEST_F(FrameNamesAndFiles, LinkToAFrameIsRecognised) {
    ASSERT_EQ(symlink("f00001.5000.png", (folder_ / "data.feather").c_str()), 0);
    EXPECT_TRUE(names_.may_be(folder_ / "data.feather"));
}

TEST_F(FrameNamesAndFiles, OtherFilesAreNotTakenForFrames) {
    for (char const* name : {"f1.5000.png", "f00001.5000.feather", "g00001.5000.png", "f0000x.5000.png", "f.png"}) {
        EXPECT_FALSE(names_.may_be(folder_ / name)) << name;
    }
    EXPECT_FALSE(names_.may_be("f00001.5000.png"));  // elsewhere
}

}  // namespace
}  // namespace pogosim
