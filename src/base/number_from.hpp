// Reading a number from text, always with a decimal point: std::strtod() expects a comma once a program, or the Python
// that runs it, has called setlocale() in a country that writes numbers so.
#pragma once

#include <string>
#include <string_view>

namespace pogosim {

/// The number that the whole text is. Infinite if it is too large; not a number if it is none.
double number_from(std::string const& text);

/// The beginning of a text that is a decimal number: digits, with or without a minus, a point and an exponent. Empty if
/// it begins with none.
std::string_view decimal_at_start(std::string_view text);

}  // namespace pogosim
