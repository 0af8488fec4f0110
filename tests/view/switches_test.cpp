#include "view/switches.hpp"

#include <SDL.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "view/actions.hpp"

namespace pogosim {
namespace {

std::vector<Switch> switches() {
    std::vector<Switch> all;
    for (auto const group : all_switches()) {
        all.insert(all.end(), group.begin(), group.end());
    }
    return all;
}

TEST(Switches, ChangeThePictureAndAreBackWhenPressedForEachChoice) {
    for (Switch const& one : switches()) {
        ViewOptions options;
        one.press(options);
        EXPECT_NE(options, ViewOptions{}) << one.effect;
        for (int i = 1; i < one.choice_count(); ++i) {
            one.press(options);
        }
        EXPECT_EQ(options, ViewOptions{}) << one.effect;
    }
}

TEST(Switches, OfChannelsGoesFromOffToBelowToAbove) {
    Switch const& channels = *switch_of(SDLK_F5);
    ViewOptions options;
    EXPECT_EQ(channels.choice_count(), 3);
    channels.press(options);
    EXPECT_EQ(options.links, LinkLayer::below);
    channels.press(options);
    EXPECT_EQ(options.links, LinkLayer::above);
}

TEST(Switches, OfTwoOptionsIsOffWhenBothAre) {
    Switch const& overlays = *switch_of(SDLK_F8);  // time and scale bar
    ViewOptions options;
    options.time = false;
    overlays.press(options);  // the scale bar is on
    EXPECT_FALSE(options.scale_bar);
    overlays.press(options);
    EXPECT_TRUE(options.time && options.scale_bar);
}

TEST(Switches, HaveKeysOfTheirOwnWhichTheHelpTells) {
    std::set<std::int32_t> keys;
    for (Switch const& one : switches()) {
        if (one.key == 0) {
            continue;
        }
        EXPECT_TRUE(keys.insert(one.key).second) << one.effect;
        EXPECT_EQ(action_of(one.key, false), std::nullopt) << one.effect;
        EXPECT_TRUE(std::ranges::any_of(help_lines(), [&](Help const& line) {
            return std::string(line.input) == one.key_name && std::string(line.effect) == one.effect;
        })) << one.effect;
    }
    EXPECT_EQ(switch_of(0), nullptr);
}

}  // namespace
}  // namespace pogosim
