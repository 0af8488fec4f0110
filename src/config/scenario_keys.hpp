// The top-level keys, and the maps under them: link_keys.cpp, magnetometer_keys.cpp and flash_keys.cpp.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "config/key.hpp"
#include "config/magnetometer_config.hpp"
#include "config/map_reader.hpp"
#include "config/scenario.hpp"

namespace pogosim {

/// Fills everything but objects, parameters and resolved.
void read_top_level(MapReader& reader, Scenario& scenario);

// `links`: springs, rods and hinges between objects.

inline constexpr std::string_view kLinksMap =
    "a map of links, such as {skeleton: {between: robots, topology: triangular}}";

/// The key `links` of the top level. Returns its values.
Node read_links(MapReader const& top, std::vector<LinkConfig>& links);

/// Lines of the reference: the keys of an entry.
std::vector<KeyDescription> link_keys_reference();

// The keys of the map `magnetometer`.

inline constexpr std::string_view kMagnetometerMap = "a map of keys, such as {source: csv, csv: {file: table.csv}}";

/// Reads the keys of the map and of the maps in it; the caller finishes the reader.
MagnetometerConfig read_magnetometer_map(MapReader& reader);

/// The same from the map under `magnetometer` of the top level.
MagnetometerConfig read_magnetometer(MapReader& top);

// `flash_state`: the files that keep robots' flash memory; and the values of `flash`.

inline constexpr std::string_view kFlashStateMap = "a map of keys, such as {input_file: a.flash, output_file: b.flash}";

/// The names of `flash`.
NamedValues<std::optional<FlashWrites>> flash_writes();

/// `top` reads the top level.
FlashStateConfig read_flash_state(MapReader& top);

/// The same from the map `flash_state` itself; the caller finishes the reader.
FlashStateConfig read_flash_state_map(MapReader& reader);

// The keys of the map `view`: what pictures show.

inline constexpr std::string_view kViewMap = "a map of keys, such as {trails: true, links: below}";

/// Reads the map; the caller finishes the reader. Keys that are absent leave options as they are.
void read_view_map(MapReader& reader, ViewOptions& options);

/// Options as YAML of that map, but for the selected robot; and from there. Throws ConfigError.
std::string view_as_yaml(ViewOptions const& options);
ViewOptions view_from_yaml(std::string const& yaml);

/// Reads that map, the older keys for what is in it, and those of the window, from the top level of a configuration.
void read_view(MapReader& reader, ViewConfig& view);

}  // namespace pogosim
