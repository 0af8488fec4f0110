// The values under `parameters` for the global variables of a user's program. Names are dotted paths as in find_path.
// Each function returns nothing for a value that is absent or null, and throws ConfigError ("file:line: parameters.x:
// expected ..., found ...") for one of another type or out of range.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/range.hpp"
#include "config/tree.hpp"

namespace pogosim {

std::optional<bool> bool_parameter(Node const& parameters, std::string_view name);

constexpr double kLargestNumber = std::numeric_limits<double>::max();

/// A number from -largest to largest, or .inf, -.inf or .nan.
std::optional<double> number_parameter(Node const& parameters, std::string_view name, double largest = kLargestNumber);

/// An integer from `min` to `max`; the fraction of a number is dropped. Exact up to 2^53.
std::optional<std::int64_t> integer_parameter(Node const& parameters, std::string_view name, std::int64_t min,
                                              std::int64_t max);

std::optional<std::string> text_parameter(Node const& parameters, std::string_view name);

/// The first `size` numbers of a list, each as in number_parameter; nothing for an empty list. A list with fewer is a
/// ConfigError.
std::optional<std::vector<double>> numbers_parameter(Node const& parameters, std::string_view name, std::size_t size,
                                                     double largest = kLargestNumber);

/// Throws ConfigError, whatever the value is: the program expects another one.
[[noreturn]] void refuse_parameter(Node const& parameters, std::string_view name, std::string_view expected);

/// Throws ConfigError unless `value`, which the program has after reading this name, is in the range.
void check_parameter_range(Node const& parameters, std::string_view name, double value, Range const& range);

}  // namespace pogosim
