#include "view/mouse_states.hpp"

#include <gtest/gtest.h>

namespace pogosim {
namespace {

void expect_next(MouseStates& mouse, float x_px, bool left_is_down) {
    MouseState const state = mouse.take();
    EXPECT_EQ(state.point_px.x, x_px);
    EXPECT_EQ(state.left_is_down, left_is_down);
}

TEST(MouseStates, StayAsTheyAreWhileNothingHappens) {
    MouseStates mouse;
    expect_next(mouse, 0.0F, false);
    mouse.set_left({3.0F, 0.0F}, true);
    expect_next(mouse, 3.0F, true);
    expect_next(mouse, 3.0F, true);
}

TEST(MouseStates, AreAllSeenOfAClickWithinOnePictureWhereItWas) {
    MouseStates mouse;
    mouse.move({3.0F, 0.0F});
    mouse.set_left({3.0F, 0.0F}, true);
    mouse.set_left({3.0F, 0.0F}, false);
    mouse.move({70.0F, 0.0F});
    EXPECT_EQ(mouse.last().point_px.x, 70.0F);
    expect_next(mouse, 3.0F, false);
    expect_next(mouse, 3.0F, true);
    expect_next(mouse, 3.0F, false);
    expect_next(mouse, 70.0F, false);
    expect_next(mouse, 70.0F, false);
}

TEST(MouseStates, OfAMotionOnlyTheLastOneCountsAndTheButtonStaysDown) {
    MouseStates mouse;
    mouse.set_left({3.0F, 0.0F}, true);
    for (int i = 0; i < 1000; ++i) {
        mouse.move({static_cast<float>(i), 0.0F});
    }
    expect_next(mouse, 3.0F, true);
    expect_next(mouse, 999.0F, true);
}

}  // namespace
}  // namespace pogosim
