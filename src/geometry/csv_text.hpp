// Text files of comma-separated values, as arenas and imported formations are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pogosim {

/// What separates fields, and begins lines that are no data.
struct CsvStyle {
    char delimiter = ',';
    std::string_view comment_prefix = "#";  // empty: there are no comments
};

struct CsvLine {
    std::size_t number = 0;  // from 1
    std::string text;        // without spaces and tabs at either end; empty for a blank line; more lines if in quotes
};

struct CsvText {
    std::vector<CsvLine> lines;
    std::vector<CsvLine> comments;  // lines that start with the prefix, without it
};

/// The bytes of a text file. Throws ConfigError when it is not a regular file that can be read, or is larger than
/// 256 MiB.
std::string read_text(std::filesystem::path const& path);

/// All lines of a text, which is that of a file. Accepts a UTF-8 byte order mark and line ends of every kind; a field
/// in double quotes may have line ends (RFC 4180). Throws ConfigError when quotes are not closed.
CsvText csv_in(std::string_view text, std::filesystem::path const& path, CsvStyle const& style = {});

/// csv_in() of read_text().
CsvText read_csv(std::filesystem::path const& path, CsvStyle const& style = {});

/// Fields between delimiters, without spaces and tabs at either end, nor one pair of double quotes around them. In
/// these, delimiters are text, and two quotes stand for one.
std::vector<std::string> split_fields(std::string_view line, char delimiter = ',');

/// A finite decimal number ("-1.5e3", "+2"), or nothing.
std::optional<double> parse_number(std::string_view field);

/// The text in quotes for a message: unprintable bytes as \xNN, at most 40 characters.
std::string in_quotes(std::string_view text);

}  // namespace pogosim
