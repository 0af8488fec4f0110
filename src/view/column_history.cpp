#include "view/column_history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pogosim {

namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
constexpr double kLow = 0.1;
constexpr double kHigh = 0.9;

/// Percentile between the two nearest ranks, linear; the order of `values` changes.
float percentile(std::vector<float>& values, double share) {
    if (values.empty()) {
        return kNoValue;
    }
    double const rank = share * static_cast<double>(values.size() - 1);
    auto const below = static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), values.begin() + below, values.end());
    float const low = values[static_cast<std::size_t>(below)];
    auto const rest = values.begin() + below + 1;
    if (rest == values.end()) {
        return low;
    }
    return low + static_cast<float>(rank - static_cast<double>(below)) * (*std::min_element(rest, values.end()) - low);
}

float mean_of(std::vector<float> const& values) {
    double const sum = std::accumulate(values.begin(), values.end(), 0.0);
    return values.empty() ? kNoValue : static_cast<float>(sum / static_cast<double>(values.size()));
}

/// Keeps the first of each two groups of `width` values.
template <class T>
void keep_every_second(std::vector<T>& values, std::size_t width) {
    std::size_t kept = 0;
    for (std::size_t group = 0; group * width < values.size(); group += 2, ++kept) {
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(group * width), width,
                    values.begin() + static_cast<std::ptrdiff_t>(kept * width));
    }
    values.resize(kept * width);
}

}  // namespace

ColumnHistory::ColumnHistory(std::size_t column_count, std::size_t robot_count)
    : column_count_(column_count), robot_count_(robot_count), swarm_(column_count), values_(column_count) {}

void ColumnHistory::add(RecordedValues const& recorded) {
    if (seen_++ % stride_ != 0) {
        return;
    }
    times_s_.push_back(recorded.time_s);
    for (std::size_t column = 0; column < column_count_; ++column) {
        std::vector<float>& values = values_[column];
        std::size_t const start = values.size();
        values.resize(start + robot_count_, kNoValue);
        std::vector<float> known;
        for (std::size_t i = 0; i < recorded.robot.size(); ++i) {
            float const value = recorded.values[column][i];
            values[start + recorded.robot[i]] = value;
            if (std::isfinite(value)) {
                known.push_back(value);
            }
        }
        swarm_[column].mean.push_back(mean_of(known));
        swarm_[column].low.push_back(percentile(known, kLow));
        swarm_[column].high.push_back(percentile(known, kHigh));
    }
    bool const too_many = times_s_.size() * column_count_ * robot_count_ > kMostValues && times_s_.size() > 2;
    if (times_s_.size() > kMostTimes || too_many) {
        thin_out();
    }
}

void ColumnHistory::thin_out() {
    stride_ *= 2;
    keep_every_second(times_s_, 1);
    for (std::size_t column = 0; column < column_count_; ++column) {
        keep_every_second(values_[column], robot_count_);
        keep_every_second(swarm_[column].mean, 1);
        keep_every_second(swarm_[column].low, 1);
        keep_every_second(swarm_[column].high, 1);
    }
}

std::vector<float> ColumnHistory::robot(std::size_t column, std::uint32_t robot) const {
    std::vector<float> series;
    series.reserve(times_s_.size());
    for (std::size_t time = 0; time < times_s_.size(); ++time) {
        series.push_back(values_[column][time * robot_count_ + robot]);
    }
    return series;
}

}  // namespace pogosim
