// The last lines that each robot has printed, for display.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace pogosim {

class PrintedLines {
public:
    static constexpr std::size_t kLinesPerRobot = 20;
    static constexpr std::size_t kLongestLine = 200;  // characters; the rest of a line is left out

    explicit PrintedLines(std::size_t robot_count) : lines_(robot_count) {}

    void add(std::uint32_t robot, std::string_view line);

    /// Oldest first; well-formed UTF-8.
    std::deque<std::string> const& of(std::uint32_t robot) const { return lines_[robot]; }

private:
    std::vector<std::deque<std::string>> lines_;  // by robot
};

}  // namespace pogosim
