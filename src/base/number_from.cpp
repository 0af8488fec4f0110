#include "base/number_from.hpp"

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

}  // namespace pogosim
