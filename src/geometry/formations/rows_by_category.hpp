// Which rows of a data file of a run belong to the objects that the formation `imported` places.
#pragma once

#include <vector>

#include "geometry/formation.hpp"

namespace pogosim {

/// Brings the rows of one instant into the order of the objects: those of each category, and behind them what is left.
/// Rows of categories that are placed apart, and of dots of membranes, are removed. Without categories, nothing
/// changes.
/// If the file has too few rows of a category, the others stay in their order, with a warning if they are of other
/// categories than the objects.
void sort_by_category(FormationSpec const& spec, std::vector<ImportedPose>& poses);

}  // namespace pogosim
