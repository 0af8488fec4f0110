#include "light/bearing_order.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/exact_math.hpp"

namespace pogosim {

BearingOrder::BearingOrder(std::vector<LitCell> const& cells, Vec2 apex_mm) {
    std::vector<std::pair<float, std::uint32_t>> seen;
    seen.reserve(cells.size());
    for (auto const& [cell, centre_mm] : cells) {
        Vec2 const offset = centre_mm - apex_mm;
        double const bearing_rad = exact::atan2(static_cast<double>(offset.y), static_cast<double>(offset.x));
        seen.emplace_back(static_cast<float>(bearing_rad), cell);
    }
    std::ranges::sort(seen);
    bearing_rad_.reserve(seen.size());
    cells_.reserve(seen.size());
    for (auto const& [bearing_rad, cell] : seen) {
        bearing_rad_.push_back(bearing_rad);
        cells_.push_back(cell);
    }
}

CellRun BearingOrder::between(double low_rad, double high_rad) const {
    auto const first = std::ranges::lower_bound(bearing_rad_, low_rad);
    auto const last = std::ranges::upper_bound(first, bearing_rad_.end(), high_rad);
    return all().subspan(static_cast<std::size_t>(first - bearing_rad_.begin()),
                         static_cast<std::size_t>(last - first));
}

std::array<CellRun, 2> BearingOrder::beam(double angle_rad, double half_width_rad) const {
    constexpr double pi = std::numbers::pi;
    if (half_width_rad >= pi) {
        return {all(), CellRun{}};
    }
    constexpr double beyond = 4.0;  // of all bearings
    double const low = std::remainder(angle_rad - half_width_rad, 2.0 * pi);
    double const high = std::remainder(angle_rad + half_width_rad, 2.0 * pi);
    if (low <= high) {
        return {between(low, high), CellRun{}};
    }
    return {between(low, beyond), between(-beyond, high)};
}

void overwrite(CellRun cells, int level, LightMap& map, std::vector<std::uint32_t>& painted) {
    for (std::uint32_t const cell : cells) {
        map.level[cell] = static_cast<std::int16_t>(level);
    }
    painted.insert(painted.end(), cells.begin(), cells.end());
}

}  // namespace pogosim
