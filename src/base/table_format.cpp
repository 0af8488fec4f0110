#include "base/table_format.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>

namespace pogosim {

namespace {

using enum TableFormat;

constexpr std::array<std::pair<std::string_view, TableFormat>, 5> kEndings{
    {{".feather", feather}, {".arrow", feather}, {".ipc", feather}, {".parquet", parquet}, {".csv", csv}}};

}  // namespace

std::optional<TableFormat> table_format(std::string const& path) {
    std::string ending = std::filesystem::path(path).extension().native();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    bool const is_number = ending.size() > 1 && std::isdigit(static_cast<unsigned char>(ending[1])) != 0;
    if (ending.size() <= 1 || is_number) {
        return feather;
    }
    auto const* const found = std::ranges::find(kEndings, ending, [](auto const& known) { return known.first; });
    return found != kEndings.end() ? std::optional(found->second) : std::nullopt;
}

}  // namespace pogosim
