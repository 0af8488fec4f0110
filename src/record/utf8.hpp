// Text of user programs is bytes of any kind; a text column of the data file holds UTF-8 only.
#pragma once

#include <string>
#include <string_view>

namespace pogosim {

/// Number of bytes from the start of `text` on that are well-formed UTF-8 (Unicode 15, table 3-7: no overlong forms, no
/// surrogates, nothing above U+10FFFF).
std::size_t well_formed_prefix(std::string_view text);

/// `text` with each byte that is not part of well-formed UTF-8 replaced by U+FFFD.
std::string replace_malformed(std::string_view text);

}  // namespace pogosim
