#include "base/json_text.hpp"

#include <fmt/format.h>

namespace pogosim {

std::string json_text(std::string_view text) {
    std::string json = "\"";
    for (char const character : text) {
        if (character == '"' || character == '\\') {
            json += '\\';
            json += character;
        } else if (static_cast<unsigned char>(character) < ' ') {
            json += fmt::format("\\u{:04x}", static_cast<unsigned>(character));
        } else {
            json += character;
        }
    }
    return json + '"';
}

}  // namespace pogosim
