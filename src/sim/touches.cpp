#include "sim/touches.hpp"

#include <fmt/format.h>

namespace pogosim {

namespace {

constexpr double kSameMoveS = 0.5;

// In the order of Touch.
constexpr std::array kWhat{"objects moved by hand", "robots clicked", "robots switched off or on", "lamps set",
                           "parameters set",        "columns set",    "links made or cut"};

std::string times(int n) {
    return n == 1 ? "once" : fmt::format("{} times", n);
}

}  // namespace

void Touches::add(Touch kind, double time_s) {
    if (!any()) {
        first_s_ = time_s;
    }
    moved_object_ = kNone;
    ++count_[static_cast<std::size_t>(kind)];
}

void Touches::add_move(std::uint32_t object, double time_s) {
    bool const goes_on = object == moved_object_ && time_s - last_move_s_ <= kSameMoveS;
    if (!goes_on) {
        add(Touch::move, time_s);
    }
    moved_object_ = object;
    last_move_s_ = time_s;
}

std::string Touches::text() const {
    if (!any()) {
        return "";
    }
    int const all = total();
    std::string what;
    for (std::size_t kind = 0; kind < kWhat.size(); ++kind) {
        if (int const n = count_[kind]; n > 0) {
            what += fmt::format("{}{}{}", what.empty() ? "" : ", ", kWhat[kind], n == all ? "" : " " + times(n));
        }
    }
    return all == 1 ? fmt::format("once, at t = {:.4f} s: {}", first_s_, what)
                    : fmt::format("{} from t = {:.4f} s on: {}", times(all), first_s_, what);
}

}  // namespace pogosim
