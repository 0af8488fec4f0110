// Keys that place the objects of one category: `poses`, or an `area` and an `initial_formation` of its own.
#pragma once

#include "config/map_reader.hpp"
#include "config/scenario.hpp"

namespace pogosim {

/// Where the objects of a tangible category start: `x`, `y` and `angle`, or `poses`, or `area` and `initial_formation`,
/// or nothing, so that the formation of all places them. `poses` also says how many there are when `nb` is absent.
void read_placement(MapReader& reader, ObjectConfig& object);

/// `area` as a disk, for the reference: `x`, `y` and `radius`.
Polygon read_disk_area(MapReader& reader);

}  // namespace pogosim
