// Pictures that other threads draw: all of them, the same whatever the number of threads.
#include "render/picture_writer.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "base/memory.hpp"
#include "support/small_world.hpp"
#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::square_world;

constexpr PictureSize kSmall{120, 90};

PictureFormat small_format() {
    return {.size = kSmall, .paint = {}};
}

Snapshot snapshot_of(World const& world, std::shared_ptr<Scenery const> const& scenery) {
    Snapshot snapshot;
    snapshot.scenery = scenery;
    snapshot.step = world.step;
    snapshot.time_s = world.time_s();
    snapshot.position_mm = world.bodies.position_mm;
    snapshot.heading_rad = world.bodies.heading_rad;
    snapshot.led = world.robots.led;
    return snapshot;
}

/// A robot on its way, in frames of these names.
class MovingRobot {
public:
    explicit MovingRobot(std::filesystem::path folder) : folder_(std::move(folder)) {
        add_robot(world_, {100, 500});
        scenery_ = std::make_shared<Scenery const>(make_scenery(world_));
    }

    World const& world() const { return world_; }

    void add_frames(PictureWriter& writer, int count) {
        for (int i = 0; i < count; ++i) {
            ++world_.step;
            world_.bodies.position_mm[0].x += 5.0F;
            writer.add({.snapshot = snapshot_of(world_, scenery_), .frame = folder_ / (std::to_string(i) + ".png")});
        }
    }

private:
    std::filesystem::path folder_;
    World world_ = square_world();
    std::shared_ptr<Scenery const> scenery_;
};

std::map<std::string, std::string> files_in(TemporaryFolder const& folder) {
    std::map<std::string, std::string> files;
    for (std::string const& name : folder.names()) {
        std::ifstream file(folder / name, std::ios::binary);
        files[name] = {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }
    return files;
}

std::map<std::string, std::string> frames_with(unsigned threads) {
    TemporaryFolder const folder;
    MovingRobot robot(folder.path());
    PictureWriter writer(small_format(), threads, nullptr);
    robot.add_frames(writer, 40);
    PictureErrors const& errors = writer.finish();
    EXPECT_EQ(errors.frames, 40);
    EXPECT_EQ(errors.frames_written, 40);
    EXPECT_TRUE(errors.lost_frame.empty());
    return files_in(folder);
}

TEST(PictureWriter, WritesTheSameFramesWithAnyNumberOfThreads) {
    auto const frames = frames_with(1);
    EXPECT_EQ(frames.size(), 40U);
    EXPECT_NE(frames.at("0.png"), frames.at("39.png"));
    EXPECT_EQ(frames, frames_with(2));
    EXPECT_EQ(frames, frames_with(7));
}

TEST(PictureWriter, CompletesItsFramesWhenItGoes) {
    TemporaryFolder const folder;
    MovingRobot robot(folder.path());
    {
        PictureWriter writer(small_format(), 2, nullptr);
        robot.add_frames(writer, 10);
    }
    EXPECT_EQ(folder.names().size(), 10U);
}

TEST(PictureWriter, NamesTheFirstFrameThatIsLostAndWritesTheOthers) {
    TemporaryFolder const folder;
    std::filesystem::create_directory(folder / "3.png");
    std::filesystem::create_directory(folder / "7.png");
    MovingRobot robot(folder.path());
    PictureWriter writer(small_format(), 3, nullptr);
    robot.add_frames(writer, 10);
    PictureErrors const& errors = writer.finish();
    EXPECT_EQ(errors.frames, 10);
    EXPECT_EQ(errors.frames_written, 8);
    EXPECT_EQ(errors.lost_frame, folder / "3.png");
    EXPECT_EQ(errors.frame_error, "Is a directory");
}

}  // namespace
}  // namespace pogosim
