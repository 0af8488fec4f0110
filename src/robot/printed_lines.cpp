#include "robot/printed_lines.hpp"

#include "base/utf8.hpp"

namespace pogosim {

namespace {

/// The first `count` characters of well-formed text.
std::string_view first_characters(std::string_view text, std::size_t count) {
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < count && bytes < text.size(); ++i) {
        bytes += first_code_point(text.substr(bytes)).bytes;
    }
    return text.substr(0, bytes);
}

}  // namespace

void PrintedLines::add(std::uint32_t robot, std::string_view line) {
    constexpr std::size_t most_bytes_per_character = 4;
    std::string const text = replace_malformed(line.substr(0, most_bytes_per_character * kLongestLine));
    std::deque<std::string>& lines = lines_[robot];
    if (lines.size() == kLinesPerRobot) {
        lines.pop_front();
    }
    lines.emplace_back(first_characters(text, kLongestLine));
}

}  // namespace pogosim
