#include "sim/touches.hpp"

#include <fmt/format.h>

namespace pogosim {

namespace {

constexpr double kSameMoveS = 0.5;

}  // namespace

void Touches::begin(double time_s) {
    if (!any()) {
        first_s_ = time_s;
    }
}

void Touches::add_move(std::uint32_t object, double time_s) {
    bool const goes_on = object == moved_object_ && time_s - last_move_s_ <= kSameMoveS;
    moved_object_ = object;
    last_move_s_ = time_s;
    if (!goes_on) {
        begin(time_s);
        ++moves_;
    }
}

void Touches::add_click(double time_s) {
    begin(time_s);
    moved_object_ = kNone;
    ++clicks_;
}

std::string Touches::text() const {
    int const count = moves_ + clicks_;
    if (!any()) {
        return "";
    }
    auto const times = [](int n) { return n == 1 ? std::string("once") : fmt::format("{} times", n); };
    std::string const what =
        clicks_ == 0  ? "objects moved by hand"
        : moves_ == 0 ? "robots clicked"
                      : fmt::format("objects moved by hand {}, robots clicked {}", times(moves_), times(clicks_));
    return count == 1 ? fmt::format("once, at t = {:.4f} s: {}", first_s_, what)
                      : fmt::format("{} from t = {:.4f} s on: {}", times(count), first_s_, what);
}

}  // namespace pogosim
