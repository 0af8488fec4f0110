// Text that is escaped for messages and for JSON (RFC 8259). Names of files and keys quoted in messages may contain any
// bytes: none may break a line or control the terminal.
#pragma once

#include <string>
#include <string_view>

namespace pogosim {

/// `text` with control characters and bytes that are not UTF-8 written as in C: "\n", "\t", "\x1b". A backslash stays
/// as it is, so that escaping twice changes nothing.
std::string escaped(std::string_view text);

/// In quotation marks, with what JSON reserves escaped. `text`: UTF-8.
std::string json_text(std::string_view text);

}  // namespace pogosim
