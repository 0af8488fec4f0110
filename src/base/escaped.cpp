#include "base/escaped.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <iterator>

#include "base/utf8.hpp"

namespace pogosim {

namespace {

bool is_control(char32_t c) {
    return c < 0x20 || (c >= 0x7F && c < 0xA0);
}

void append_escape(std::string& line, char c) {
    switch (c) {
        case '\n':
            line += "\\n";
            break;
        case '\r':
            line += "\\r";
            break;
        case '\t':
            line += "\\t";
            break;
        default:
            fmt::format_to(std::back_inserter(line), "\\x{:02x}", static_cast<unsigned char>(c));
    }
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string line;
    line.reserve(text.size());
    while (!text.empty()) {
        CodePoint const first = first_code_point(text);
        std::size_t const length = first.bytes > 0 ? first.bytes : 1;
        std::string_view const bytes = text.substr(0, length);
        if (first.bytes > 0 && !is_control(first.value)) {
            line += bytes;
        } else {
            for (char const c : bytes) {
                append_escape(line, c);
            }
        }
        text.remove_prefix(length);
    }
    return line;
}

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
