#include "render/heat_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace pogosim {

namespace {

constexpr float kDeviation = 0.04F;  // of the longer side of the arena
constexpr float kCellsPerDeviation = 2.0F;
constexpr float kReach = 3.5F;          // deviations; 0.2 % of a distribution lie beyond
constexpr float kCertainWeight = 0.3F;  // of a robot in the middle of the cell

/// The sums of weights, and of weighted values.
struct Sums {
    HeatField field;
    std::vector<float> weight;
    std::vector<float> weighted;
};

Sums empty_sums(Scenery const& scenery) {
    Box const& bounds = scenery.arena.bounds;
    Vec2 const size = bounds.size();
    Sums sums;
    HeatField& field = sums.field;
    field.origin_mm = bounds.min;
    field.cell_mm = kDeviation * std::max(size.x, size.y) / kCellsPerDeviation;
    field.columns = std::max(static_cast<int>(std::ceil(size.x / field.cell_mm)), 1);
    field.rows = std::max(static_cast<int>(std::ceil(size.y / field.cell_mm)), 1);
    auto const cells = static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows);
    sums.weight.assign(cells, 0.0F);
    sums.weighted.assign(cells, 0.0F);
    return sums;
}

/// Adds a robot around a place. Weights are 1 in its middle.
void add_around(Sums& sums, Vec2 place_mm, float value) {
    HeatField const& field = sums.field;
    float const deviation_mm = kCellsPerDeviation * field.cell_mm;
    auto const range = [&](float at_mm, float origin_mm, int count) {
        float const low = (at_mm - kReach * deviation_mm - origin_mm) / field.cell_mm;
        float const high = (at_mm + kReach * deviation_mm - origin_mm) / field.cell_mm;
        auto const most = static_cast<float>(count);
        return std::pair{static_cast<int>(std::clamp(low, 0.0F, most)),
                         static_cast<int>(std::clamp(high + 1.0F, 0.0F, most))};
    };
    auto const [left, right] = range(place_mm.x, field.origin_mm.x, field.columns);
    auto const [top, bottom] = range(place_mm.y, field.origin_mm.y, field.rows);
    auto const fall = [&](int cell, float origin_mm, float at_mm) {
        float const distance = (origin_mm + (static_cast<float>(cell) + 0.5F) * field.cell_mm - at_mm) / deviation_mm;
        return std::exp(-0.5F * distance * distance);
    };
    for (int row = top; row < bottom; ++row) {
        float const down = fall(row, field.origin_mm.y, place_mm.y);
        for (int column = left; column < right; ++column) {
            float const weight = down * fall(column, field.origin_mm.x, place_mm.x);
            auto const cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(field.columns) +
                              static_cast<std::size_t>(column);
            sums.weight[cell] += weight;
            sums.weighted[cell] += weight * value;
        }
    }
}

/// Adds all robots that have a body and a value.
Sums sums_of(Snapshot const& snapshot, std::vector<float> const* values) {
    Scenery const& scenery = *snapshot.scenery;
    Vec2 const size = scenery.arena.bounds.size();
    Sums sums = empty_sums(scenery);
    for (std::size_t robot = 0; robot < scenery.robot_body.size(); ++robot) {
        float const value = values == nullptr ? 1.0F : (*values)[robot];
        if (scenery.robot_body[robot] == kNone || !std::isfinite(value)) {
            continue;
        }
        Vec2 const place_mm = snapshot.position_mm[scenery.robot_body[robot]];
        int const beyond = scenery.periodic ? 1 : 0;
        for (int i = -beyond; i <= beyond; ++i) {
            for (int k = -beyond; k <= beyond; ++k) {
                add_around(sums, place_mm + Vec2{static_cast<float>(i) * size.x, static_cast<float>(k) * size.y},
                           value);
            }
        }
    }
    return sums;
}

}  // namespace

HeatField density_field(Snapshot const& snapshot) {
    Sums sums = sums_of(snapshot, nullptr);
    float const deviation_m = kCellsPerDeviation * sums.field.cell_mm / 1000.0F;
    float const peak_per_m2 = 1.0F / (2.0F * std::numbers::pi_v<float> * deviation_m * deviation_m);
    sums.field.certainty.assign(sums.weight.size(), 1.0F);
    sums.field.value = std::move(sums.weight);
    for (float& value : sums.field.value) {
        value *= peak_per_m2;
    }
    return sums.field;
}

HeatField mean_field(Snapshot const& snapshot, std::vector<float> const& values) {
    Sums sums = sums_of(snapshot, &values);
    sums.field.value.resize(sums.weight.size());
    sums.field.certainty.resize(sums.weight.size());
    for (std::size_t cell = 0; cell < sums.weight.size(); ++cell) {
        float const weight = sums.weight[cell];
        sums.field.value[cell] = weight > 0.0F ? sums.weighted[cell] / weight : 0.0F;
        sums.field.certainty[cell] = std::min(weight / kCertainWeight, 1.0F);
    }
    return sums.field;
}

HeatField mean_angle_field(Snapshot const& snapshot, std::vector<float> const& angles_rad) {
    std::vector<float> cosines;
    std::vector<float> sines;
    for (float const angle : angles_rad) {
        cosines.push_back(std::cos(angle));
        sines.push_back(std::sin(angle));
    }
    HeatField field = mean_field(snapshot, cosines);
    HeatField const across = mean_field(snapshot, sines);
    for (std::size_t cell = 0; cell < field.value.size(); ++cell) {
        float const x = field.value[cell];
        float const y = across.value[cell];
        field.certainty[cell] *= std::hypot(x, y);
        field.value[cell] = std::atan2(y, x);
    }
    return field;
}

}  // namespace pogosim
