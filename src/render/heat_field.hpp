// A quantity of robots as a smooth field over the arena, for heat maps.
#pragma once

#include <vector>

#include "render/snapshot.hpp"

namespace pogosim {

/// Values at the centres of square cells, row by row from the corner with the least x and y.
struct HeatField {
    int columns = 0;
    int rows = 0;
    Vec2 origin_mm;
    float cell_mm = 1.0F;
    std::vector<float> value;
    std::vector<float> certainty;  // 0, where no robot is near, to 1
};

/// Robots per square metre: the sum of a normal distribution around each, whose standard deviation is 4 % of the longer
/// side of the arena (B. W. Silverman, "Density Estimation for Statistics and Data Analysis", 1986). What lies beyond a
/// wall is not added elsewhere; in a periodic arena it is on the other side.
HeatField density_field(Snapshot const& snapshot);

/// The mean of a column, weighted by the same distributions (E. A. Nadaraya, "On Estimating Regression", 1964). Robots
/// without a value do not count. `values`: by robot.
HeatField mean_field(Snapshot const& snapshot, std::vector<float> const& values);

/// The mean direction of angles, rad, weighted likewise: that of the sum of unit vectors, whose length by robot is the
/// less certain the more they differ (K. V. Mardia and P. E. Jupp, "Directional Statistics", 2000).
HeatField mean_angle_field(Snapshot const& snapshot, std::vector<float> const& angles_rad);

}  // namespace pogosim
