#include "sim/touches.hpp"

#include <fmt/format.h>

#include <utility>

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

void Touches::add_switch(double time_s) {
    begin(time_s);
    moved_object_ = kNone;
    ++switches_;
}

std::string Touches::text() const {
    int const count = moves_ + clicks_ + switches_;
    if (!any()) {
        return "";
    }
    auto const times = [](int n) { return n == 1 ? std::string("once") : fmt::format("{} times", n); };
    std::string what;
    for (auto const& [did, n] : {std::pair{"objects moved by hand", moves_}, std::pair{"robots clicked", clicks_},
                                 std::pair{"robots or lamps switched", switches_}}) {
        if (n > 0) {
            bool const is_all = n == count;
            what += (what.empty() ? "" : ", ") + std::string(did) + (is_all ? "" : " " + times(n));
        }
    }
    return count == 1 ? fmt::format("once, at t = {:.4f} s: {}", first_s_, what)
                      : fmt::format("{} from t = {:.4f} s on: {}", times(count), first_s_, what);
}

}  // namespace pogosim
