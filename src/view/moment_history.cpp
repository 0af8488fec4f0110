#include "view/moment_history.hpp"

#include <algorithm>
#include <utility>

namespace pogosim {

namespace {

template <class T>
std::size_t bytes_of(std::vector<T> const& values) {
    return values.size() * sizeof(T);
}

std::size_t bytes_of(Moment const& moment) {
    Snapshot const& snapshot = moment.snapshot;
    std::size_t const columns = (snapshot.color_by ? bytes_of(snapshot.color_by->values) : 0) +
                                (snapshot.heat_map ? bytes_of(snapshot.heat_map->values) : 0);
    return sizeof(Moment) + bytes_of(snapshot.position_mm) + bytes_of(snapshot.heading_rad) + bytes_of(snapshot.led) +
           bytes_of(snapshot.lamps) + bytes_of(snapshot.links) + bytes_of(snapshot.body_links) +
           bytes_of(snapshot.velocity_mm_s) + bytes_of(snapshot.heard) + columns +
           (snapshot.light ? bytes_of(snapshot.light->level) : 0);  // which several moments may share
}

}  // namespace

void MomentHistory::add(Moment const& moment) {
    while (!moments_.empty() && moments_.back()->snapshot.step >= moment.snapshot.step) {
        bytes_ -= bytes_of(*moments_.back());
        moments_.pop_back();
    }
    auto kept = std::make_shared<Moment>(moment);
    kept->snapshot.trails = nullptr;
    kept->recorded.clear();
    bytes_ += bytes_of(*kept);
    moments_.push_back(std::move(kept));
    while (moments_.size() > 1 && (last_s() - first_s() > longest_s_ || bytes_ > kMostBytes)) {
        bytes_ -= bytes_of(*moments_.front());
        moments_.pop_front();
    }
}

std::size_t MomentHistory::index_at(double time_s) const {
    auto const after =
        std::ranges::upper_bound(moments_, time_s, {}, [](auto const& moment) { return moment->snapshot.time_s; });
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - moments_.begin() - 1, 0));
}

std::shared_ptr<Moment const> MomentHistory::at(double time_s) const {
    return moments_[index_at(time_s)];
}

double MomentHistory::neighbour_s(double time_s, int direction) const {
    auto const index = static_cast<std::ptrdiff_t>(index_at(time_s)) + direction;
    auto const last = static_cast<std::ptrdiff_t>(moments_.size()) - 1;
    return moments_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index, 0, last))]->snapshot.time_s;
}

}  // namespace pogosim
