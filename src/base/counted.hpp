// How many of something there are, in a message: "1 row", "3 rows".
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace pogosim {

template <class Integer>
std::string counted(Integer count, std::string_view one) {
    return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

}  // namespace pogosim
