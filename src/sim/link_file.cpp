#include "sim/make_links.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "base/error.hpp"
#include "base/input_hash.hpp"
#include "config/range.hpp"
#include "config/scenario.hpp"
#include "geometry/csv_text.hpp"

namespace pogosim {

namespace {

/// The columns of a table: a row needs the first ones, and may have the others.
struct Table {
    std::vector<std::string> names;
    std::size_t needed;
};

struct Row {
    std::vector<std::optional<double>> values;  // in the order of the table
    std::string where;
};

std::string names_text(Table const& table) {
    std::span<std::string const> const all(table.names);
    std::string text = fmt::format("{}", fmt::join(all.first(table.needed), ", "));
    return all.size() == table.needed
               ? text
               : fmt::format("{} and optionally {}", text, fmt::join(all.subspan(table.needed), ", "));
}

/// Index into the table of each column of the file.
std::vector<std::size_t> columns_of(Table const& table, std::vector<std::string> const& header,
                                    std::string const& where) {
    std::vector<std::size_t> columns;
    for (std::string const& name : header) {
        auto const found = std::ranges::find(table.names, name);
        auto const column = static_cast<std::size_t>(found - table.names.begin());
        if (found == table.names.end() || std::ranges::find(columns, column) != columns.end()) {
            throw ConfigError(fmt::format("{}: expected a header with the columns {}, found {}{}", where,
                                          names_text(table), in_quotes(name),
                                          found == table.names.end() ? "" : " twice"));
        }
        columns.push_back(column);
    }
    for (std::size_t i = 0; i < table.needed; ++i) {
        if (std::ranges::find(columns, i) == columns.end()) {
            throw ConfigError(fmt::format("{}: expected a header with the columns {}, found no {}", where,
                                          names_text(table), table.names[i]));
        }
    }
    return columns;
}

/// The columns of a file without a header, in the order of the table.
std::vector<std::size_t> first_columns(Table const& table, std::size_t count, std::string const& where) {
    if (count < table.needed || count > table.names.size()) {
        throw ConfigError(fmt::format("{}: expected the columns {}, found {} fields between commas", where,
                                      names_text(table), count));
    }
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < count; ++i) {
        columns.push_back(i);
    }
    return columns;
}

std::vector<Row> read_table(std::filesystem::path const& file, Table const& table) {
    std::vector<Row> rows;
    std::optional<std::vector<std::size_t>> columns;
    std::string const text = read_text(file);
    InputHash::note(text);
    for (CsvLine const& line : csv_in(text, file).lines) {
        if (line.text.empty()) {
            continue;
        }
        std::string const where = fmt::format("{}:{}", file.string(), line.number);
        std::vector<std::string> const fields = split_fields(line.text);
        if (!columns) {
            bool const is_header = std::ranges::none_of(fields, [](auto& field) { return bool(parse_number(field)); });
            columns = is_header ? columns_of(table, fields, where) : first_columns(table, fields.size(), where);
            if (is_header) {
                continue;
            }
        }
        if (fields.size() != columns->size()) {
            throw ConfigError(
                fmt::format("{}: expected {} fields between commas, found {}", where, columns->size(), fields.size()));
        }
        Row row{.values = std::vector<std::optional<double>>(table.names.size()), .where = where};
        for (std::size_t i = 0; i < fields.size(); ++i) {
            std::size_t const column = (*columns)[i];
            bool const may_be_empty = column >= table.needed;
            row.values[column] = parse_number(fields[i]);
            if (!row.values[column] && !(may_be_empty && fields[i].empty())) {
                throw ConfigError(fmt::format("{}: {}: expected a number, found {}", where, table.names[column],
                                              in_quotes(fields[i])));
            }
        }
        rows.push_back(std::move(row));
    }
    if (rows.empty()) {
        throw ConfigError(fmt::format("{}: no rows; expected the columns {}", file.string(), names_text(table)));
    }
    return rows;
}

std::uint32_t object_number(Row const& row, std::size_t column, Table const& table, std::size_t count) {
    double const number = *row.values[column];
    if (number < 0.0 || number != std::floor(number) || number >= static_cast<double>(count)) {
        throw ConfigError(fmt::format("{}: {}: expected the number of an object, 0 to {}, found {}", row.where,
                                      table.names[column], count - 1, number_text(number)));
    }
    return static_cast<std::uint32_t>(number);
}

float length_in(Row const& row, std::size_t column, Table const& table, double least) {
    double const length = *row.values[column];
    if (length < least || length > kMaxLength) {
        throw ConfigError(fmt::format("{}: {}: expected a number from {} to {} (mm), found {}", row.where,
                                      table.names[column], number_text(least), number_text(kMaxLength),
                                      number_text(length)));
    }
    return static_cast<float>(length);
}

}  // namespace

std::vector<ListedLink> read_listed_links(std::filesystem::path const& file, std::size_t count_a, std::size_t count_b) {
    Table const table{.names = {"a", "b", "length"}, .needed = 2};
    std::vector<ListedLink> links;
    for (Row const& row : read_table(file, table)) {
        ListedLink link{.a = object_number(row, 0, table, count_a),
                        .b = object_number(row, 1, table, count_b),
                        .length_mm = std::nullopt,
                        .where = row.where};
        if (row.values[2]) {
            link.length_mm = length_in(row, 2, table, 0.0);
        }
        links.push_back(std::move(link));
    }
    return links;
}

std::vector<ListedPlace> read_listed_places(std::filesystem::path const& file, std::size_t count) {
    Table const table{.names = {"a", "x", "y"}, .needed = 3};
    std::vector<ListedPlace> places;
    for (Row const& row : read_table(file, table)) {
        places.push_back({.a = object_number(row, 0, table, count),
                          .place_mm = {length_in(row, 1, table, -kMaxLength), length_in(row, 2, table, -kMaxLength)},
                          .where = row.where});
    }
    return places;
}

}  // namespace pogosim
