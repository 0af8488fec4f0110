#include "view/actions.hpp"

#include <SDL.h>
#include <gtest/gtest.h>

#include <string>

#include "view/switches.hpp"

namespace pogosim {
namespace {

TEST(Keys, LettersActInBothCases) {
    EXPECT_EQ(action_of(SDLK_s, false), Action::step);
    EXPECT_EQ(action_of(SDLK_s, true), Action::step);
}

TEST(Keys, ShiftAsksForTheNextSeed) {
    EXPECT_EQ(action_of(SDLK_r, false), Action::restart);
    EXPECT_EQ(action_of(SDLK_r, true), Action::restart_with_next_seed);
}

TEST(Keys, TheKeypadZoomsAndPans) {
    EXPECT_EQ(action_of(SDLK_KP_PLUS, false), Action::zoom_in);
    EXPECT_EQ(action_of(SDLK_KP_MINUS, false), Action::zoom_out);
    EXPECT_EQ(action_of(SDLK_KP_0, false), Action::reset_view);
    EXPECT_EQ(action_of(SDLK_KP_4, false), Action::pan_left);
}

TEST(Keys, EveryFunctionKeyOfTheHelpDoesSomething) {
    std::string text;
    for (Help const& line : help_lines()) {
        text += std::string(line.input) + ", ";
    }
    for (int i = 1; i <= 12; ++i) {
        bool const is_told = text.find("F" + std::to_string(i) + ",") != std::string::npos;
        SDL_Keycode const key = SDLK_F1 + i - 1;
        EXPECT_EQ(is_told, action_of(key, false).has_value() || switch_of(key) != nullptr) << "F" << i;
    }
}

TEST(Keys, OthersDoNothing) {
    EXPECT_EQ(action_of(SDLK_q, false), std::nullopt);
    EXPECT_EQ(action_of(SDLK_UNKNOWN, false), std::nullopt);
}

TEST(Keys, ThatAreHeldDownStepZoomAndPanAndNothingElse) {
    EXPECT_EQ(action_of(SDLK_s, false, true), Action::step);
    EXPECT_EQ(action_of(SDLK_PLUS, false, true), Action::zoom_in);
    EXPECT_EQ(action_of(SDLK_KP_4, false, true), Action::pan_left);
    EXPECT_EQ(action_of(SDLK_COMMA, false, true), Action::look_back);
    for (int const key : {SDLK_SPACE, SDLK_r, SDLK_F1, SDLK_F9, SDLK_F12, SDLK_ESCAPE, SDLK_f}) {
        EXPECT_EQ(action_of(key, false, true), std::nullopt) << key;
    }
}

}  // namespace
}  // namespace pogosim
