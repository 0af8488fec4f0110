// The keys of the map `magnetometer`.
#pragma once

#include <string_view>

#include "config/magnetometer_config.hpp"
#include "config/map_reader.hpp"

namespace pogosim {

inline constexpr std::string_view kMagnetometerMap = "a map of keys, such as {source: csv, csv: {file: table.csv}}";

/// Reads the keys of the map and of the maps in it; the caller finishes the reader.
MagnetometerConfig read_magnetometer_map(MapReader& reader);

/// The same from the map under `magnetometer` of the top level.
MagnetometerConfig read_magnetometer(MapReader& top);

}  // namespace pogosim
