// The moment that the window shows: the newest one of the run, or one of the last seconds that the user looks at again.
#pragma once

#include <memory>
#include <optional>

#include "view/messages.hpp"
#include "view/moment_history.hpp"

namespace pogosim {

class ShownMoment {
public:
    /// Moments of so much simulated time can be looked at again.
    explicit ShownMoment(double history_s) : history_(history_s) {}

    /// Takes the newest moment. If trails are shown and it has none, it gets those of an earlier one.
    void take(Moment const& newest, bool shows_trails);

    /// Null: there is none yet.
    Moment const* newest() const { return newest_.get(); }

    /// Whether the trails that there are will do for the next moment: drawing them takes the most time, and robots
    /// have not left the ends of theirs yet.
    bool has_fresh_trails() const;

    // Wishes of the user, which choose() follows.

    /// The moment of a time; the newest one for its time and later ones. Returns whether it is one of the past.
    bool look_at(double time_s);
    /// The one before (-1) or after (1) the one that is looked at. Returns whether it is one of the past.
    bool look_at_neighbour(int direction);
    void look_at_newest() { time_s_.reset(); }

    /// The time that is looked at; absent: the newest moment is shown.
    std::optional<double> past_time_s() const { return time_s_; }

    /// Finds the moment that is to be drawn. There must be a newest one.
    void choose();

    /// The moment that choose() found last, which is on the screen, or the newest one. There must be a newest one.
    Moment const& on_screen() const { return past_ ? *past_ : *newest_; }

private:
    MomentHistory history_;
    std::unique_ptr<Moment> newest_;
    std::shared_ptr<Trails const> trails_;  // the newest
    double trails_time_s_ = 0.0;
    std::optional<double> time_s_;
    std::shared_ptr<Moment const> past_;  // of `time_s_`
};

}  // namespace pogosim
