// `flash_state`: the files that keep robots' flash memory; and the values of `flash`.
#pragma once

#include <optional>
#include <string_view>

#include "config/map_reader.hpp"
#include "config/scenario.hpp"

namespace pogosim {

inline constexpr std::string_view kFlashStateMap = "a map of keys, such as {input_file: a.flash, output_file: b.flash}";

/// The names of `flash`.
NamedValues<std::optional<FlashWrites>> flash_writes();

/// `top` reads the top level.
FlashStateConfig read_flash_state(MapReader& top);

/// The same from the map `flash_state` itself; the caller finishes the reader.
FlashStateConfig read_flash_state_map(MapReader& reader);

}  // namespace pogosim
