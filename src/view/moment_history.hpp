// The moments of the last seconds, which the window keeps to show them again.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>

#include "view/messages.hpp"

namespace pogosim {

class MomentHistory {
public:
    static constexpr std::size_t kMostBytes = std::size_t{256} << 20U;

    explicit MomentHistory(double longest_s) : longest_s_(longest_s) {}

    /// Takes the newest moment, if it is later than those that are kept. One that is earlier follows a step back: what
    /// was after it is forgotten. Trails, which have no times, are left out.
    void add(Moment const& moment);

    bool empty() const { return moments_.empty(); }
    double first_s() const { return moments_.front()->snapshot.time_s; }
    double last_s() const { return moments_.back()->snapshot.time_s; }

    /// The last moment that is not after a time; the first of all where there is none. There must be one.
    std::shared_ptr<Moment const> at(double time_s) const;

    /// The time of the moment before, or after, the one of a time; itself at an end.
    double neighbour_s(double time_s, int direction) const;

private:
    std::size_t index_at(double time_s) const;

    double longest_s_;
    std::deque<std::shared_ptr<Moment const>> moments_;  // in the order of time
    std::size_t bytes_ = 0;                              // about, of all
};

}  // namespace pogosim
