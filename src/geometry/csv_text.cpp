#include "geometry/csv_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <system_error>

#include "base/error.hpp"

namespace pogosim {

namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{256} << 20U;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\v\f";
    std::size_t const first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string read_text(std::filesystem::path const& path) {
    std::error_code error;
    std::filesystem::file_status const status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        throw ConfigError(fmt::format("{}: no such file", path.string()));
    }
    if (!std::filesystem::is_regular_file(status)) {
        throw ConfigError(fmt::format("{}: expected a CSV file, found {}", path.string(),
                                      std::filesystem::is_directory(status) ? "a folder" : "a special file"));
    }
    if (std::filesystem::file_size(path, error) > kLargestFile) {
        throw ConfigError(fmt::format("{}: larger than 256 MiB; keep only the lines that are needed", path.string()));
    }
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file) {
        throw ConfigError(fmt::format("{}: cannot be read; check its permissions", path.string()));
    }
    return text;
}

}  // namespace

CsvText read_csv(std::filesystem::path const& path) {
    std::string const text = read_text(path);
    std::string_view rest = text;
    if (rest.starts_with(kByteOrderMark)) {
        rest.remove_prefix(kByteOrderMark.size());
    }
    CsvText csv;
    for (std::size_t number = 1; !rest.empty(); ++number) {
        std::size_t const end = std::min(rest.find_first_of("\r\n"), rest.size());
        std::string_view const line = trimmed(rest.substr(0, end));
        if (line.starts_with('#')) {
            csv.comments.push_back({number, std::string(trimmed(line.substr(1)))});
        } else {
            csv.lines.push_back({number, std::string(line)});
        }
        rest.remove_prefix(end);
        rest.remove_prefix(rest.starts_with("\r\n") ? 2 : std::min<std::size_t>(rest.size(), 1));
    }
    return csv;
}

std::vector<std::string_view> split_fields(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t start = 0; start <= line.size();) {
        std::size_t const end = std::min(line.find(',', start), line.size());
        std::string_view field = trimmed(line.substr(start, end - start));
        if (field.size() >= 2 && field.starts_with('"') && field.ends_with('"')) {
            field = trimmed(field.substr(1, field.size() - 2));
        }
        fields.push_back(field);
        start = end + 1;
    }
    return fields;
}

std::optional<double> parse_number(std::string_view field) {
    if (field.starts_with('+') && !field.starts_with("+-")) {
        field.remove_prefix(1);
    }
    double value = 0.0;
    char const* const end = field.data() + field.size();
    auto const [stop, error] = std::from_chars(field.data(), end, value);
    if (error != std::errc{} || stop != end || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string shown = "'";
    for (char const c : text.substr(0, longest)) {
        auto const byte = static_cast<unsigned char>(c);
        shown += byte >= 0x20 && byte < 0x7f ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
    }
    return shown + (text.size() > longest ? "...'" : "'");
}

}  // namespace pogosim
