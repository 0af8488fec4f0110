// Restarts replace this test program by itself: the new one looks at what the old one has left for it.
#include "app/restart.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

namespace fs = std::filesystem;

constexpr auto kToldVariable = "POGOSIM_RESTART";
constexpr auto kCaseVariable = "POGOSIM_TEST_CASE";
constexpr auto kFolderVariable = "POGOSIM_TEST_FOLDER";

/// No two numbers are the same, and no switch is as it is at first.
Restart everything_changed() {
    WindowState window{.x_px = -17,
                       .y_px = 23,
                       .size = {640, 481},
                       .full_screen = true,
                       .camera = Camera{.centre_mm = {123.456F, -0.1F}, .scale_px_mm = 0.7654321F},
                       .paused = true,
                       .panels = false,
                       .plot = true,
                       .column = 5,
                       .speed_up = 1.0 / 3.0,
                       .options = {.time = false,
                                   .scale_bar = false,
                                   .links = LinkLayer::above,
                                   .lateral_leds = false,
                                   .light_levels = true,
                                   .trails = true,
                                   .labels = true,
                                   .velocities = true,
                                   .heard = true,
                                   .color_by = "two: words",
                                   .heat_map = kDensity,
                                   .theme = Theme::light,
                                   .palette = PaletteKind::color_blind,
                                   .follow = 12,
                                   .zoom = 2.5,
                                   .history_s = 7.0,
                                   .pause_when = "x > 1 and 'y' < 2",
                                   .selected_robot = 41}};
    return {.seed = 4294967295U, .window = window};
}

/// Runs that end in different ways; of the switches, each is on in one of them alone.
std::vector<Restart> cases() {
    std::vector<Restart> all{everything_changed(), {.seed = 7}};
    WindowState off;
    off.panels = off.options.time = off.options.scale_bar = off.options.lateral_leds = false;
    std::vector<std::function<void(WindowState&)>> const changes{
        [](WindowState&) {},
        [](WindowState& window) { window.full_screen = true; },
        [](WindowState& window) { window.paused = true; },
        [](WindowState& window) { window.panels = true; },
        [](WindowState& window) { window.plot = true; },
        [](WindowState& window) { window.options.time = true; },
        [](WindowState& window) { window.options.scale_bar = true; },
        [](WindowState& window) { window.options.lateral_leds = true; },
        [](WindowState& window) { window.options.light_levels = true; },
        [](WindowState& window) { window.options.trails = true; },
        [](WindowState& window) { window.options.links = LinkLayer::below; },
        [](WindowState& window) { window.options.selected_robot = 0; },
        [](WindowState& window) { window.speed_up = 0.0; },
    };
    for (auto const& change : changes) {
        WindowState window = off;
        change(window);
        all.push_back({.seed = 1, .window = window});
    }
    return all;
}

void expect_equal(WindowState const& a, WindowState const& b) {
    EXPECT_EQ(a.x_px, b.x_px);
    EXPECT_EQ(a.y_px, b.y_px);
    EXPECT_EQ(a.size, b.size);
    EXPECT_EQ(a.full_screen, b.full_screen);
    EXPECT_EQ(a.camera, b.camera);
    EXPECT_EQ(a.paused, b.paused);
    EXPECT_EQ(a.panels, b.panels);
    EXPECT_EQ(a.plot, b.plot);
    EXPECT_EQ(a.column, b.column);
    EXPECT_EQ(a.speed_up, b.speed_up);
    EXPECT_EQ(a.options, b.options);
}

/// This program, as it was started.
std::string own_path() {
    static std::string const path = fs::absolute(::testing::internal::GetArgvs().front()).string();
    return path;
}

/// Restarts this program in a folder, to run the test of what it finds there alone. Never returns.
void start_next_run(fs::path const& folder, std::size_t index) {
    std::string program = own_path();
    std::string filter = "--gtest_filter=Restart.TellsTheNextRun*";
    char* argv[] = {program.data(), filter.data(), nullptr};
    setenv(kCaseVariable, std::to_string(index).c_str(), 1);
    setenv(kFolderVariable, fs::canonical(folder).c_str(), 1);
    fs::current_path("/");  // as a program may do
    restart_program(argv, folder, cases()[index]);
    std::_Exit(99);
}

/// What a run finds when it was left this text.
std::optional<Restart> taken(char const* text) {
    setenv(kToldVariable, text, 1);
    return take_restart();
}

/// In the run that was started: it finds what it was left.
void expect_restart(Restart const& expected) {
    EXPECT_EQ(fs::current_path(), std::getenv(kFolderVariable));
    auto const found = take_restart();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->seed, expected.seed);
    ASSERT_EQ(found->window.has_value(), expected.window.has_value());
    if (found->window) {
        expect_equal(*found->window, *expected.window);
    }
}

TEST(Restart, TellsTheNextRunItsSeedAndAllThatTheWindowShowed) {
    if (char const* const index = std::getenv(kCaseVariable)) {
        expect_restart(cases()[std::stoul(index)]);
        return;
    }
    TemporaryFolder const folder;
    own_path();
    for (std::size_t i = 0; i < cases().size(); ++i) {
        EXPECT_EXIT(start_next_run(folder.path(), i), ::testing::ExitedWithCode(0), "") << i;
    }
}

TEST(Restart, OfAFolderThatHasGoneIsStillOne) {
    TemporaryFolder const folder;
    own_path();
    auto const start = [&] {
        std::string program = own_path();
        std::string list = "--gtest_list_tests";
        char* argv[] = {program.data(), list.data(), nullptr};
        restart_program(argv, folder / "gone", {.seed = 1});
        std::_Exit(99);
    };
    EXPECT_EXIT(start(), ::testing::ExitedWithCode(0), "");
}

TEST(Restart, IsToldOnce) {
    auto const first = taken("12 1");
    ASSERT_TRUE(first);
    EXPECT_EQ(first->seed, 12U);
    EXPECT_TRUE(first->overwrite);
    EXPECT_EQ(std::getenv(kToldVariable), nullptr);
    EXPECT_FALSE(take_restart());
}

TEST(Restart, WithoutASeedIsNone) {
    for (char const* const text : {"", " ", "next", "12", "12 2", "x 1 2 3", "99999999999 0"}) {
        EXPECT_FALSE(taken(text)) << text;
    }
}

TEST(Restart, WithAWindowThatMakesNoSenseHasTheSeedAlone) {
    for (char const* const text : {
             "3 0", "3 0 1 2", "3 0 10 20 800 600 0 0 0 0 0 1 1 0 -1",  // one number is missing
             "3 0 10 20 800 600 2 0 0 0 0 1 1 0 0 -1",                  // neither off nor on
             "3 0 10 20 wide 600 0 0 0 0 0 1 1 0 0 -1",                 //
             "3 0 10 20 800 600 0 nan 0 0 0 1 1 0 0 -1",                //
             "3 0 10 20 800 600 0 0 0 0 0 1 1 0 0 -1\nlinks: beside",   // no such layer
             "3 0 10 20 800 600 0 0 0 0 0 1 1 0 0 -1\nlinks: [",        // no YAML
             "3 0 10 20 800 600 0 0 0 0 0 1 1 0 0 -1 robot",            // no map
         }) {
        auto const restart = taken(text);
        ASSERT_TRUE(restart) << text;
        EXPECT_EQ(restart->seed, 3U) << text;
        EXPECT_FALSE(restart->window) << text;
    }
    auto const whole = taken("3 0 10 20 800 600 0 0 0 0 0 1 1 0 0 -1\nlinks: above");
    ASSERT_TRUE(whole && whole->window);
    EXPECT_EQ(whole->window->size, (PictureSize{800, 600}));
    EXPECT_FALSE(whole->window->camera);
    EXPECT_EQ(whole->window->options.links, LinkLayer::above);
}

}  // namespace
}  // namespace pogosim
