// Cells sorted by the direction in which one sees them from a lighthouse. Those in its beam are then one run of the
// list, or two where it wraps around, found without visiting the others.
//
//     bearing  -pi ........|======|............ pi      beam of +- half width around an angle
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "light/lit_area.hpp"

namespace pogosim {

using CellRun = std::span<std::uint32_t const>;

class BearingOrder {
public:
    /// As seen from `apex_mm`. A cell with its centre at the apex has bearing 0.
    BearingOrder(std::vector<LitCell> const& cells, Vec2 apex_mm);

    CellRun all() const { return cells_; }

    /// The cells whose bearing differs from the angle by at most the half width (above 0), once each.
    std::array<CellRun, 2> beam(double angle_rad, double half_width_rad) const;

private:
    CellRun between(double low_rad, double high_rad) const;

    std::vector<float> bearing_rad_;  // of each cell; ascending, -pi to pi
    std::vector<std::uint32_t> cells_;
};

/// Gives the cells this level, and appends them to `painted`.
void overwrite(CellRun cells, int level, LightMap& map, std::vector<std::uint32_t>& painted);

}  // namespace pogosim
