// Text in JSON: RFC 8259.
#pragma once

#include <string>
#include <string_view>

namespace pogosim {

/// In quotation marks, with what JSON reserves escaped. `text`: UTF-8.
std::string json_text(std::string_view text);

}  // namespace pogosim
