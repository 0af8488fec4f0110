#include "base/number_from.hpp"

#include <algorithm>
#include <clocale>
#include <cstdlib>
#include <limits>

#ifdef __APPLE__
#include <xlocale.h>
#endif

namespace pogosim {

double number_from(std::string const& text) {
    static locale_t const locale = newlocale(LC_ALL_MASK, "C", nullptr);
    char* end = nullptr;
    double const number = strtod_l(text.c_str(), &end, locale);
    bool const is_whole = !text.empty() && end == text.c_str() + text.size();
    return is_whole ? number : std::numeric_limits<double>::quiet_NaN();
}

std::string_view decimal_at_start(std::string_view text) {
    constexpr std::string_view digits = "0123456789";
    auto const after_digits = [&](std::size_t at) { return std::min(text.find_first_not_of(digits, at), text.size()); };
    auto const stands_at = [&](std::size_t at, std::string_view letters) {
        return at < text.size() && letters.find(text[at]) != std::string_view::npos;
    };
    std::size_t const begin = stands_at(0, "-") ? 1 : 0;
    std::size_t end = after_digits(begin);
    std::size_t count = end - begin;
    if (stands_at(end, ".")) {
        std::size_t const fraction = end + 1;
        end = after_digits(fraction);
        count += end - fraction;
    }
    if (count == 0) {
        return {};
    }
    if (stands_at(end, "eE")) {
        std::size_t const exponent = end + (stands_at(end + 1, "+-") ? 2 : 1);
        end = stands_at(exponent, digits) ? after_digits(exponent) : end;
    }
    return text.substr(0, end);
}

}  // namespace pogosim
