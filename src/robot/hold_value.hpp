// Setting a column for the whole run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "robot/context.hpp"

namespace pogosim {

/// The column has this value in the rows of all objects, or of one of `object_count`, from now on. Throws ConfigError
/// for an unknown column and for a value that the type of the column does not have.
void hold_value(DataExport& data, std::size_t object_count, std::optional<std::uint32_t> object, std::string_view name,
                double value);

}  // namespace pogosim
