// The mouse, for panels that look at it once per picture: no click is lost, however quick.
#pragma once

#include <deque>

#include "base/vec2.hpp"

namespace pogosim {

struct MouseState {
    Vec2 point_px;
    bool left_is_down = false;
};

/// What happened since the last picture, in its order: one press or release for each picture.
class MouseStates {
public:
    void move(Vec2 point_px) {
        if (waiting_.empty() || waiting_.back().is_button) {
            waiting_.push_back({.state = last(), .is_button = false});
        }
        waiting_.back().state.point_px = point_px;
    }

    void set_left(Vec2 point_px, bool is_down) {
        waiting_.push_back({.state = {.point_px = point_px, .left_is_down = is_down}, .is_button = true});
    }

    /// The mouse in the next picture.
    MouseState take() {
        if (!waiting_.empty()) {
            seen_ = waiting_.front().state;
            waiting_.pop_front();
        }
        return seen_;
    }

    /// The mouse now.
    MouseState last() const { return waiting_.empty() ? seen_ : waiting_.back().state; }

private:
    struct Waiting {
        MouseState state;
        bool is_button;  // pressed or released, else moved
    };
    std::deque<Waiting> waiting_;
    MouseState seen_;
};

}  // namespace pogosim
