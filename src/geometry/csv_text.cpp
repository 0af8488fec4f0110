#include "geometry/csv_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "base/number_from.hpp"

namespace pogosim {

namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{256} << 20U;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Blanks around fields; a character that separates them is none.
std::string_view blanks(char delimiter) {
    switch (delimiter) {
        case '\t':
            return " \v\f";
        case ' ':
            return "\t\v\f";
        default:
            return " \t\v\f";
    }
}

std::string_view trimmed(std::string_view text, char delimiter) {
    std::size_t const first = text.find_first_not_of(blanks(delimiter));
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(blanks(delimiter)) - first + 1);
}

/// Where the field that begins at `start` ends: at a delimiter or the end of the line outside double quotes, or with
/// the text. npos: its quotes are not closed.
std::size_t end_of_field(std::string_view text, std::size_t start, char delimiter) {
    std::size_t next = text.find_first_not_of(blanks(delimiter), start);
    if (next < text.size() && text[next] == '"') {
        do {
            std::size_t const closing = text.find('"', next + 1);
            if (closing == std::string_view::npos) {
                return closing;
            }
            next = closing + 1;
        } while (next < text.size() && text[next] == '"');  // two of them stand for one
    } else {
        next = start;
    }
    std::array const ends{delimiter, '\r', '\n'};
    return std::min(text.find_first_of(ends.data(), next, ends.size()), text.size());
}

bool is_comment(std::string_view line, CsvStyle const& style) {
    return !style.comment_prefix.empty() && line.starts_with(style.comment_prefix);
}

/// Where the first line ends, which texts in double quotes may continue below. npos: their quotes are not closed.
std::size_t end_of_line(std::string_view text, CsvStyle const& style) {
    std::size_t const first = text.find_first_not_of(blanks(style.delimiter));
    if (first < text.size() && is_comment(text.substr(first), style)) {
        return std::min(text.find_first_of("\r\n"), text.size());
    }
    std::size_t end = end_of_field(text, 0, style.delimiter);
    while (end < text.size() && text[end] == style.delimiter) {
        end = end_of_field(text, end + 1, style.delimiter);
    }
    return end;
}

std::size_t count_line_ends(std::string_view text) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        count += text[i] == '\n' || (text[i] == '\r' && !text.substr(i + 1).starts_with('\n')) ? 1 : 0;
    }
    return count;
}

std::string without_quotes(std::string_view field) {
    if (field.size() < 2 || !field.starts_with('"') || !field.ends_with('"')) {
        return std::string(field);
    }
    std::string text(trimmed(field.substr(1, field.size() - 2), ','));
    for (std::size_t at = text.find("\"\""); at != std::string::npos; at = text.find("\"\"", at + 1)) {
        text.erase(at, 1);
    }
    return text;
}

}  // namespace

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

CsvText csv_in(std::string_view text, std::filesystem::path const& path, CsvStyle const& style) {
    std::string_view rest = text;
    if (rest.starts_with(kByteOrderMark)) {
        rest.remove_prefix(kByteOrderMark.size());
    }
    CsvText csv;
    for (std::size_t number = 1; !rest.empty();) {
        std::size_t const end = end_of_line(rest, style);
        if (end == std::string_view::npos) {
            throw ConfigError(fmt::format("{}:{}: a text in double quotes begins on this line and does not end",
                                          path.string(), number));
        }
        std::string_view const line = trimmed(rest.substr(0, end), style.delimiter);
        if (is_comment(line, style)) {
            csv.comments.push_back(
                {number, std::string(trimmed(line.substr(style.comment_prefix.size()), style.delimiter))});
        } else {
            csv.lines.push_back({number, std::string(line)});
        }
        number += 1 + count_line_ends(line);
        rest.remove_prefix(end);
        rest.remove_prefix(rest.starts_with("\r\n") ? 2 : std::min<std::size_t>(rest.size(), 1));
    }
    return csv;
}

CsvText read_csv(std::filesystem::path const& path, CsvStyle const& style) {
    return csv_in(read_text(path), path, style);
}

std::vector<std::string> split_fields(std::string_view line, char delimiter) {
    std::vector<std::string> fields;
    for (std::size_t start = 0; start <= line.size();) {
        std::size_t const end = std::min(end_of_field(line, start, delimiter), line.size());
        fields.push_back(without_quotes(trimmed(line.substr(start, end - start), delimiter)));
        start = end + 1;
    }
    return fields;
}

std::optional<double> parse_number(std::string_view field) {
    if (field.starts_with('+') && !field.starts_with("+-")) {
        field.remove_prefix(1);
    }
    if (decimal_at_start(field).size() != field.size()) {
        return std::nullopt;
    }
    double const value = number_from(std::string(field));
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
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
