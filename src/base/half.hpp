// Half-precision numbers (IEEE 754 binary16), the cells of float16 columns.
#pragma once

#include <cstdint>

namespace pogosim {

/// Bits of the half-precision number nearest to `value` (any double), ties to even. From 65520 on: infinity. NaN stays
/// NaN, and zero keeps its sign. Source: IEEE 754-2019, sections 3.6 and 4.3.1.
std::uint16_t to_half(double value);

/// The value of such bits, exactly.
double from_half(std::uint16_t bits);

}  // namespace pogosim
