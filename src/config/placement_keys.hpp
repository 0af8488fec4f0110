// Keys that place the objects of one category: `poses`, or an `area` and an `initial_formation` of its own.
#pragma once

#include "config/map_reader.hpp"
#include "config/scenario.hpp"

namespace pogosim {

/// Where the objects of a category with a body start: `x`, `y` and `angle`, or `poses`, or `area` and
/// `initial_formation`; without any of these, the common formation places them. `poses` also says how many there are
/// when `nb` is absent.
void read_placement(MapReader& reader, ObjectConfig& object);

/// `area` as a disk, for the reference: `x`, `y` and `radius`.
Polygon read_disk_area(MapReader& reader);

}  // namespace pogosim
