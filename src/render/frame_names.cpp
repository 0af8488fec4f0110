#include "render/frame_names.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/locked_file.hpp"
#include "base/number_from.hpp"
#include "base/rounded_time.hpp"

namespace pogosim {

namespace {

/// The path with its folder as it really is, but without following the last component.
std::filesystem::path with_real_folder(std::filesystem::path const& path) {
    auto const folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    return real_path(folder) / path.filename();
}

}  // namespace

FrameNames::FrameNames(std::string pattern)
    : pattern_(std::move(pattern)),
      before_(pattern_.substr(0, pattern_.find('{'))),
      after_(pattern_.substr(pattern_.find('}') + 1)) {}

std::filesystem::path FrameNames::at(double time_s) const {
    return fmt::format(fmt::runtime(pattern_), rounded_to_ns(time_s));
}

std::optional<std::filesystem::path> FrameNames::folder() const {
    if (after_.find('/') != std::string::npos) {
        return std::nullopt;
    }
    std::filesystem::path folder = std::filesystem::path(before_ + "0").parent_path();
    return folder.empty() ? "." : folder;
}

bool FrameNames::may_be(std::filesystem::path const& path) const {
    std::filesystem::path const start = with_real_folder(before_ + "0");
    std::string const before = start.native().substr(0, start.native().size() - 1);
    for (std::string const& name : {with_real_folder(path).native(), real_path(path).native()}) {
        if (name.size() <= before.size() + after_.size() || !name.starts_with(before) || !name.ends_with(after_)) {
            continue;
        }
        std::string const field = name.substr(before.size(), name.size() - before.size() - after_.size());
        double const time_s = number_from(field);
        if (std::isfinite(time_s) && at(time_s).native() == before_ + field + after_) {
            return true;
        }
    }
    return false;
}

}  // namespace pogosim
