// What earlier runs have written stays beside the files of a new one.
#include "sim/kept_files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "base/locked_file.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

namespace fs = std::filesystem;

void write(fs::path const& path, std::string const& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

std::string content_of(fs::path const& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

class KeptFiles : public ::testing::Test {
protected:
    KeptFiles() : scenario_(testing::square_scene({})) {
        scenario_.output.enable_data_logging = true;
        scenario_.output.data_filename = at("run.feather");
    }

    std::string at(std::string const& name) const { return folder_ / name; }

    TemporaryFolder const folder_;
    Scenario scenario_;
};

TEST_F(KeptFiles, WithoutEarlierFilesNothingIsRenamed) {
    EXPECT_TRUE(earlier_files(scenario_, at("film.mp4")).empty());
    EXPECT_TRUE(keep_earlier_files(scenario_, at("film.mp4")).empty());
}

TEST_F(KeptFiles, EachFileGetsTheFirstFreeNumber) {
    scenario_.output.message_log = at("messages.feather");
    write(at("run.feather"), "third");
    write(at("run.1.feather"), "first");
    write(at("run.2.feather"), "second");
    write(at("messages.feather"), "messages");
    write(at("film.mp4"), "film");
    auto const announced = earlier_files(scenario_, at("film.mp4"));
    auto const kept = keep_earlier_files(scenario_, at("film.mp4"));
    ASSERT_EQ(kept.size(), 3U);
    ASSERT_EQ(announced.size(), 3U);
    for (std::size_t i = 0; i < kept.size(); ++i) {
        EXPECT_EQ(announced[i].kept, kept[i].kept);
    }
    EXPECT_FALSE(fs::exists(at("run.feather")));
    EXPECT_EQ(content_of(at("run.1.feather")), "first");
    EXPECT_EQ(content_of(at("run.2.feather")), "second");
    EXPECT_EQ(content_of(at("run.3.feather")), "third");
    EXPECT_EQ(content_of(at("messages.1.feather")), "messages");
    EXPECT_EQ(content_of(at("film.1.mp4")), "film");
}

TEST_F(KeptFiles, FramesMoveToAFolderOfTheirOwnAndOtherFilesStay) {
    scenario_.view.save_video_period_s = 0.1;
    scenario_.view.frames_name = at("frames/f{:010.4f}.png");
    write(at("frames/f00000.1000.png"), "frame");
    write(at("frames/f00000.2000.png"), "another");
    write(at("frames/notes.txt"), "mine");
    fs::create_directory(at("frames.1"));
    auto const kept = keep_earlier_files(scenario_, "");
    ASSERT_EQ(kept.size(), 1U);
    EXPECT_EQ(kept[0].kept.filename(), "frames.2");
    EXPECT_EQ(content_of(at("frames.2/f00000.1000.png")), "frame");
    EXPECT_EQ(content_of(at("frames.2/f00000.2000.png")), "another");
    EXPECT_EQ(content_of(at("frames/notes.txt")), "mine");
    EXPECT_FALSE(fs::exists(at("frames/f00000.1000.png")));
}

TEST_F(KeptFiles, EmptyFileIsNothingToKeep) {
    write(at("run.feather"), "");
    EXPECT_TRUE(earlier_files(scenario_, "").empty());
    EXPECT_TRUE(keep_earlier_files(scenario_, "").empty());
    EXPECT_TRUE(fs::exists(at("run.feather")));
}

TEST_F(KeptFiles, WhatAnotherRunIsWritingStays) {
    write(at("run.feather"), "half");
    LockedFile const other(at("run.feather"));
    EXPECT_TRUE(keep_earlier_files(scenario_, "").empty());
    EXPECT_EQ(content_of(at("run.feather")), "half");
}

TEST_F(KeptFiles, SymbolicLinkGoesOnLeadingToItsPlace) {
    write(at("disk/real.feather"), "old");
    fs::create_symlink(at("disk/real.feather"), at("run.feather"));
    ASSERT_EQ(keep_earlier_files(scenario_, "").size(), 1U);
    EXPECT_EQ(content_of(at("disk/real.1.feather")), "old");
    EXPECT_TRUE(fs::is_symlink(at("run.feather")));
}

TEST_F(KeptFiles, CsvFileTakesItsMetadataWithIt) {
    scenario_.output.data_filename = at("run.csv");
    write(at("run.csv"), "rows");
    write(at("run.csv.yaml"), "metadata");
    write(at("run.1.csv.yaml"), "another file's");
    auto const kept = keep_earlier_files(scenario_, "");
    ASSERT_EQ(kept.size(), 1U);
    EXPECT_EQ(content_of(at("run.2.csv")), "rows");
    EXPECT_EQ(content_of(at("run.2.csv.yaml")), "metadata");
    EXPECT_FALSE(fs::exists(at("run.csv.yaml")));
    EXPECT_EQ(content_of(at("run.1.csv.yaml")), "another file's");
}

TEST_F(KeptFiles, RunThatDoesNotStartGivesThemBack) {
    scenario_.output.data_filename = at("run.csv");
    scenario_.output.message_log = at("messages.feather");
    scenario_.view.save_video_period_s = 0.1;
    scenario_.view.frames_name = at("frames/f{:010.4f}.png");
    write(at("run.csv"), "rows");
    write(at("run.csv.yaml"), "metadata");
    write(at("messages.feather"), "old");
    write(at("frames/f00000.1000.png"), "frame");
    auto const kept = keep_earlier_files(scenario_, "");
    ASSERT_EQ(kept.size(), 3U);
    write(at("messages.feather"), "new");
    give_back(kept);
    EXPECT_EQ(content_of(at("run.csv")), "rows");
    EXPECT_EQ(content_of(at("run.csv.yaml")), "metadata");
    EXPECT_EQ(content_of(at("messages.feather")), "new");
    EXPECT_EQ(content_of(at("messages.1.feather")), "old");
    EXPECT_EQ(content_of(at("frames/f00000.1000.png")), "frame");
    EXPECT_FALSE(fs::exists(at("frames.1")));
}

TEST_F(KeptFiles, RunWithoutDataKeepsNoDataFile) {
    scenario_.output.enable_data_logging = false;
    write(at("run.feather"), "another program's");
    EXPECT_TRUE(keep_earlier_files(scenario_, "").empty());
}

}  // namespace
}  // namespace pogosim
