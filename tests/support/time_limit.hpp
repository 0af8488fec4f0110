#pragma once

#include <string>

namespace pogosim::testing {

inline constexpr int kLongestTestS = 600;

/// Ends this process with exit code 1 and a line on stderr, unless called again within so many seconds of wall-clock
/// time. 0: no limit.
void limit_time(std::string const& what, int seconds);

}  // namespace pogosim::testing
