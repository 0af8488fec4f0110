#include "sim/recorded_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <type_traits>
#include <variant>

#include "base/utf8.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kMostMoments = 1024;

}  // namespace

namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// The built-in columns that a plot shows.
struct BuiltIn {
    std::string_view name;
    float (*value)(ObjectRow const& row);
};
constexpr std::array<BuiltIn, 4> kBuiltIns{{
    {"pogobot_ticks", [](ObjectRow const& row) { return row.ticks ? static_cast<float>(*row.ticks) : kNoValue; }},
    {"x", [](ObjectRow const& row) { return row.x_mm; }},
    {"y", [](ObjectRow const& row) { return row.y_mm; }},
    {"angle", [](ObjectRow const& row) { return row.angle_rad; }},
}};

float number_of(CellValue const& cell) {
    return std::visit(
        [](auto const& value) {
            if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
                return static_cast<float>(value);
            } else {
                return kNoValue;
            }
        },
        cell);
}

struct Text {
    std::string operator()(std::monostate /*null*/) const { return "null"; }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return fmt::format("{:.6g}", value); }
    std::string operator()(std::string const& value) const { return replace_malformed(value); }
};

bool is_number(ColumnSpec const& column) {
    return column.type != ColumnType::text;
}

}  // namespace

void RecordedRows::open(std::vector<ColumnSpec> const& user_columns,
                        std::optional<std::vector<std::string>> const& fields) {
    auto const is_kept = [&fields](std::string_view name) {
        return !fields || std::ranges::find(*fields, name) != fields->end();
    };
    for (std::size_t i = 0; i < kBuiltIns.size(); ++i) {
        if (is_kept(kBuiltIns[i].name)) {
            built_in_kept_.push_back(i);
            columns_.emplace_back(kBuiltIns[i].name);
        }
    }
    user_columns_ = user_columns;
    for (ColumnSpec const& column : user_columns) {
        user_is_kept_.push_back(is_kept(column.name));
        if (user_is_kept_.back() && is_number(column)) {
            columns_.push_back(replace_malformed(column.name));
        }
    }
}

void RecordedRows::begin(double time_s) {
    present_ = {.time_s = time_s, .robot = {}, .values = std::vector<std::vector<float>>(columns_.size())};
}

void RecordedRows::add(std::uint32_t robot, ObjectRow const& row, std::span<CellValue const> user) {
    last_[robot] = {.exists = true, .built_in = row, .user = {user.begin(), user.end()}};
    present_.robot.push_back(robot);
    std::size_t column = 0;
    for (std::size_t const i : built_in_kept_) {
        present_.values[column++].push_back(kBuiltIns[i].value(row));
    }
    for (std::size_t i = 0; i < user_columns_.size(); ++i) {
        if (user_is_kept_[i] && is_number(user_columns_[i])) {
            present_.values[column++].push_back(number_of(user[i]));
        }
    }
}

void RecordedRows::end() {
    if (moments_.size() >= kMostMoments) {
        // The window does not take them, because its display hangs. Every second one is enough for a plot.
        for (std::size_t i = 1; 2 * i < moments_.size(); ++i) {
            moments_[i] = std::move(moments_[2 * i]);
        }
        moments_.resize(moments_.size() / 2);
    }
    moments_.push_back(std::move(present_));
}

std::pair<double, std::vector<std::pair<std::string, std::string>>> RecordedRows::last_row(std::uint32_t robot) const {
    std::vector<std::pair<std::string, std::string>> cells;
    Row const& row = last_[robot];
    if (!row.exists) {
        return {};
    }
    for (std::size_t const i : built_in_kept_) {
        bool const is_count = i == 0;
        float const value = kBuiltIns[i].value(row.built_in);
        cells.emplace_back(kBuiltIns[i].name, is_count ? fmt::format("{:.0f}", value) : fmt::format("{:.6g}", value));
    }
    for (std::size_t i = 0; i < user_columns_.size(); ++i) {
        if (user_is_kept_[i]) {
            cells.emplace_back(replace_malformed(user_columns_[i].name), std::visit(Text(), row.user[i]));
        }
    }
    return {row.built_in.time_s, std::move(cells)};
}

}  // namespace pogosim
