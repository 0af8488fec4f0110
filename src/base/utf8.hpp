// Text of users (configurations, names, what programs write) is bytes of any kind. This tells which of them are text:
// well-formed UTF-8 (Unicode 15, table 3-7: no overlong forms, no surrogates, nothing above U+10FFFF).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace pogosim {

/// The character that malformed bytes are replaced by, U+FFFD.
inline constexpr char32_t kReplacementCharacter = 0xFFFD;

struct CodePoint {
    char32_t value = kReplacementCharacter;
    std::size_t bytes = 0;  ///< 1 to 4; 0: the text is empty or does not start with a well-formed sequence
};

/// The code point that `text` starts with.
CodePoint first_code_point(std::string_view text);

/// Number of bytes from the start of `text` on that are well-formed.
std::size_t well_formed_prefix(std::string_view text);

/// `text` with each byte that is not part of a well-formed sequence replaced by U+FFFD.
std::string replace_malformed(std::string_view text);

}  // namespace pogosim
