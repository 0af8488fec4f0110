// The names of frames: `frames_name` of a configuration, with one field for the time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pogosim {

class FrameNames {
public:
    /// `pattern`: a text with one field of fmt in braces, which takes a number: "frames/f{:010.4f}.png".
    explicit FrameNames(std::string pattern);

    /// The path of the frame at a time in s, which is rounded to 1 ns.
    std::filesystem::path at(double time_s) const;

    /// The folder of all frames, "." if the pattern has none; nothing if it depends on the time.
    std::optional<std::filesystem::path> folder() const;

    /// True if some frame may have this path, by this name or through symbolic links.
    bool may_be(std::filesystem::path const& path) const;

private:
    std::string pattern_;
    std::string before_;  // the field
    std::string after_;
};

}  // namespace pogosim
