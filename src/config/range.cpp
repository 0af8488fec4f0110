#include "config/range.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace pogosim {

std::string number_text(double value) {
    constexpr double kExactIntegers = 1.0e15;
    if (std::isnan(value)) {
        return ".nan";
    }
    if (std::isinf(value)) {
        return value > 0 ? ".inf" : "-.inf";
    }
    if (std::trunc(value) == value && std::abs(value) < kExactIntegers) {
        return fmt::format("{}", static_cast<std::int64_t>(value));
    }
    return fmt::format("{}", value);
}

std::string Range::text() const {
    bool const has_min = std::isfinite(min);
    bool const has_max = std::isfinite(max);
    if (!has_min && !has_max && with_infinity && with_nan) {
        return "";
    }
    std::string text;
    if (has_min && has_max && !without_min) {
        text = fmt::format(" from {} to {}", number_text(min), number_text(max));
    } else if (has_min && has_max) {
        text = fmt::format(" above {}, at most {}", number_text(min), number_text(max));
    } else if (has_min) {
        text = fmt::format(" {} {}", without_min ? "above" : "of at least", number_text(min));
    } else if (has_max) {
        text = fmt::format(" of at most {}", number_text(max));
    }
    return text + (with_infinity ? " or .inf" : "") + (with_nan ? " or .nan" : "");
}

}  // namespace pogosim
