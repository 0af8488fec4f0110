// How the polygons of a drawing lie to each other: whether any edges cross, and which polygon is inside which.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/polygon.hpp"

namespace pogosim {

/// An edge of one of several polygons; it goes from corner `edge` to the next one.
struct EdgeOf {
    std::size_t polygon = 0;
    std::size_t edge = 0;

    friend bool operator==(EdgeOf, EdgeOf) = default;
};

struct OutlineSurvey {
    /// Two edges that cross or touch without being neighbours in one polygon, or neighbours that fold back on each
    /// other; the one nearer to the start comes first.
    std::optional<std::pair<EdgeOf, EdgeOf>> crossing;
    /// The innermost polygon around each polygon. Meaningful only when nothing crosses.
    std::vector<std::optional<std::size_t>> parent;
};

/// Sweeps a line over all edges, which takes O(n log n) for n corners: M. I. Shamos and D. Hoey, "Geometric
/// intersection problems", FOCS 1976. Each polygon needs at least 3 corners; a corner that repeats its predecessor
/// counts as a touch. Orientation tests are exact as long as differences of coordinates are exact in double precision.
OutlineSurvey survey_outlines(std::span<Polygon const> polygons);

}  // namespace pogosim
