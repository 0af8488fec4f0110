#include "config/values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <system_error>

#include "base/escaped.hpp"
#include "base/log.hpp"
#include "base/number_from.hpp"
#include "base/problems.hpp"
#include "config/option_keys.hpp"

namespace pogosim {

namespace {

/// Digits in bases other than ten, behind their prefix.
std::optional<double> number_in_base(std::string_view digits, int base) {
    std::uint64_t value = 0;
    auto const [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
    bool const is_whole = error == std::errc() && end == digits.data() + digits.size();
    return is_whole ? std::optional(static_cast<double>(value)) : std::nullopt;
}

std::size_t count_digits(std::string_view text) {
    auto const is_digit = [](char c) { return c >= '0' && c <= '9'; };
    return static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
}

/// True for digits with at most one point, and an optional exponent; no sign.
bool is_decimal(std::string_view text) {
    std::size_t const whole = count_digits(text);
    text.remove_prefix(whole);
    std::size_t fraction = 0;
    if (text.starts_with('.')) {
        fraction = count_digits(text.substr(1));
        text.remove_prefix(1 + fraction);
    }
    if (whole + fraction == 0) {
        return false;
    }
    if (text.starts_with('e') || text.starts_with('E')) {
        text.remove_prefix(1);
        if (text.starts_with('+') || text.starts_with('-')) {
            text.remove_prefix(1);
        }
        std::size_t const exponent = count_digits(text);
        return exponent > 0 && exponent == text.size();
    }
    return text.empty();
}

std::optional<double> unsigned_number(std::string const& text) {
    if (text.starts_with("0x") || text.starts_with("0X")) {
        return number_in_base(std::string_view(text).substr(2), 16);
    }
    if (text.starts_with("0o")) {
        return number_in_base(std::string_view(text).substr(2), 8);
    }
    if (text == ".inf" || text == ".Inf" || text == ".INF") {
        return std::numeric_limits<double>::infinity();
    }
    return is_decimal(text) ? std::optional(number_from(text)) : std::nullopt;
}

std::string with_unit(std::string text, std::string_view unit) {
    return unit.empty() ? text : fmt::format("{} ({})", text, unit);
}

/// The limits, narrowed to what the type holds and a double holds exactly.
template <class Integer>
Limits limits_of_type(Limits limits) {
    constexpr double kExact = 9007199254740992.0;  // 2^53
    using Type = std::numeric_limits<Integer>;
    limits.range.min = std::max({limits.range.min, static_cast<double>(Type::min()), -kExact});
    limits.range.max = std::min({limits.range.max, static_cast<double>(Type::max()), kExact});
    return limits;
}

template <class Integer>
std::string expected_integer(Limits const& limits) {
    return with_unit("an integer" + limits_of_type<Integer>(limits).range.text(), limits.unit);
}

template <class Integer>
void read_integer(Place const& place, Limits const& limits, Integer& value) {
    std::optional<double> const number = number_of(place.node);
    bool const is_refused = number && limits.range.without_fraction && std::trunc(*number) != *number;
    if (!number || is_refused || !limits_of_type<Integer>(limits).range.contains(std::trunc(*number))) {
        fail_expected(place, expected_integer<Integer>(limits));
    }
    value = static_cast<Integer>(*number);
}

std::string expected_number(Limits const& limits) {
    return with_unit("a number" + limits.range.text(), limits.unit);
}

/// The range is checked after rounding to the type, so that the value in use is in the range.
template <class Real>
void read_real(Place const& place, Limits const& limits, Real& value) {
    std::optional<double> const number = number_of(place.node);
    if (!number || !limits.range.contains(static_cast<Real>(*number))) {
        fail_expected(place, expected_number(limits));
    }
    value = static_cast<Real>(*number);
}

/// A unit that is easily confused with that of a key.
struct SimilarUnit {
    std::string_view expected;
    std::string_view taken;
    double factor;  // one of the taken ones is this many of the expected ones
};
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::array kSimilarUnits{
    SimilarUnit{"mm", "metres", 1e3},
    SimilarUnit{"mm/s", "metres per second", 1e3},
    SimilarUnit{"mm2", "square metres", 1e6},
    SimilarUnit{"rad", "degrees", kDegree},
    SimilarUnit{"degrees", "radians", 1.0 / kDegree},
    SimilarUnit{"rad/s", "degrees per second", kDegree},
};

/// Reads a list of exactly N values.
template <class T, std::size_t N>
std::array<T, N> read_tuple(Place const& place, Limits const& limits, std::string const& expected) {
    if (place.node.kind != Node::Kind::sequence) {
        fail_expected(place, expected);
    }
    if (std::size_t const count = place.node.items.size(); count != N) {
        fail_at(place, fmt::format("expected {}, found a list of {}", expected, count));
    }
    std::array<T, N> values{};
    for (std::size_t i = 0; i < N; ++i) {
        read_value({place.node.items[i], fmt::format("{}.{}", place.path, i)}, limits, values[i]);
    }
    return values;
}

/// The fewest digits that are read back as the same number.
template <class Real>
std::string shortest_text(Real value) {
    return std::isfinite(value) ? fmt::format("{}", value) : number_text(value);
}

template <class Values>
Node sequence(Values const& values) {
    Node node;
    node.kind = Node::Kind::sequence;
    for (auto const& value : values) {
        node.items.push_back(value_node(value));
    }
    return node;
}

/// A hint for a map of options whose words are all misspelt, and for values of a batch without their word.
std::string option_hint(Node const& node) {
    auto const is_value = [](Node const& item) { return item.kind == Node::Kind::scalar; };
    if (node.items.size() > 1 && std::ranges::all_of(node.items, is_value)) {
        return "; several values for a batch are written {batch_options: [...], default_option: ...}";
    }
    for (auto const& [key, value] : node.entries) {
        if (std::string_view const word = misspelt_option(key); !word.empty()) {
            return fmt::format("; did you mean '{}', not '{}'?", word, shown(key));
        }
    }
    return {};
}

}  // namespace

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string found_text(Node const& node) {
    switch (node.kind) {
        case Node::Kind::null:
            return "nothing";
        case Node::Kind::sequence:
            return "a list";
        case Node::Kind::map:
            return "a map";
        case Node::Kind::scalar:
            break;
    }
    return number_of(node) ? node.scalar : fmt::format("'{}'", shown(node.scalar));
}

std::string shown(std::string_view text) {
    constexpr std::size_t kMaxLength = 60;
    std::string line(text.substr(0, kMaxLength));
    // Cut between characters: bytes 10xxxxxx continue one.
    while (text.size() > kMaxLength && !line.empty() &&
           (static_cast<unsigned char>(text[line.size()]) & 0xC0U) == 0x80U) {
        line.pop_back();
    }
    return escaped(line) + (text.size() > kMaxLength ? "..." : "");
}

void fail_at(Place const& place, std::string_view what) {
    throw KeyError(place.path, fmt::format("{}: {}: {}", place.node.where(), shown(place.path), what));
}

bool is_open_option(Node const& node) {
    return node.kind == Node::Kind::null && !node.scalar.empty();
}

void fail_expected(Place const& place, std::string_view expected) {
    if (is_open_option(place.node)) {
        fail_at(place, place.node.scalar);
    }
    bool const is_list = place.node.kind == Node::Kind::sequence;
    bool const takes_list = expected.starts_with('[') || (is_list && expected.starts_with("a list"));
    std::string const length = is_list && takes_list ? fmt::format(" of {}", place.node.items.size()) : "";
    fail_at(place, fmt::format("expected {}, found {}{}{}", expected, found_text(place.node), length,
                               takes_list ? "" : option_hint(place.node)));
}

std::optional<double> number_of(Node const& node) {
    if (node.kind != Node::Kind::scalar) {
        return std::nullopt;
    }
    std::string const& text = node.scalar;
    if (text == ".nan" || text == ".NaN" || text == ".NAN") {
        return std::numeric_limits<double>::quiet_NaN();
    }
    bool const is_signed = text.starts_with('+') || text.starts_with('-');
    std::optional<double> const number = unsigned_number(is_signed ? text.substr(1) : text);
    return number && text.starts_with('-') ? std::optional(-*number) : number;
}

std::optional<bool> truth_of(Node const& node) {
    constexpr std::array<std::string_view, 3> kTrue{"true", "yes", "on"};
    constexpr std::array<std::string_view, 3> kFalse{"false", "no", "off"};
    if (node.kind != Node::Kind::scalar) {
        return std::nullopt;
    }
    std::string const text = lower_case(node.scalar);
    std::optional<double> const number = number_of(node);
    if (std::ranges::find(kTrue, text) != kTrue.end() || number == 1.0) {
        return true;
    }
    return std::ranges::find(kFalse, text) != kFalse.end() || number == 0.0 ? std::optional(false) : std::nullopt;
}

void read_value(Place const& place, Limits const& limits, bool& value) {
    std::optional<bool> const truth = truth_of(place.node);
    if (!truth) {
        fail_expected(place, expected_text(limits, value));
    }
    value = *truth;
}

void read_value(Place const& place, Limits const& limits, int& value) {
    read_integer(place, limits, value);
}
void read_value(Place const& place, Limits const& limits, std::int64_t& value) {
    read_integer(place, limits, value);
}
void read_value(Place const& place, Limits const& limits, std::uint32_t& value) {
    read_integer(place, limits, value);
}
/// All 64 bits, of which a double would round some away.
void read_value(Place const& place, Limits const& limits, std::uint64_t& value) {
    std::string const& text = place.node.scalar;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    bool const is_whole = place.node.kind == Node::Kind::scalar && error == std::errc() &&
                          end == text.data() + text.size() && !text.empty();
    if (is_whole) {
        return;
    }
    std::optional<double> const number = number_of(place.node);
    if (!number || !limits_of_type<std::uint64_t>(limits).range.contains(std::trunc(*number))) {
        fail_expected(place, expected_text(limits, value));
    }
    value = static_cast<std::uint64_t>(*number);
}
void read_value(Place const& place, Limits const& limits, float& value) {
    read_real(place, limits, value);
}
void read_value(Place const& place, Limits const& limits, double& value) {
    read_real(place, limits, value);
}

void read_value(Place const& place, Limits const& limits, std::string& value) {
    if (place.node.kind != Node::Kind::scalar) {
        fail_expected(place, expected_text(limits, value));
    }
    value = place.node.scalar;
}

void read_value(Place const& place, Limits const& limits, Vec2& value) {
    auto const [x, y] = read_tuple<float, 2>(place, limits, expected_text(limits, value));
    value = {x, y};
}

void read_value(Place const& place, Limits const& limits, IntRange& value) {
    auto const [min, max] = read_tuple<int, 2>(place, limits, expected_text(limits, value));
    if (min > max) {
        fail_at(place, fmt::format("expected [smallest, largest], found [{}, {}]", min, max));
    }
    value = {min, max};
}

void read_value(Place const& place, Limits const& limits, Interval& value) {
    std::string const expected = expected_text(limits, value);
    if (place.node.kind == Node::Kind::sequence && place.node.items.size() == 1) {
        auto const [both] = read_tuple<double, 1>(place, limits, expected);
        value = {both, both};
        return;
    }
    auto const [min, max] = read_tuple<double, 2>(place, limits, expected);
    if (min > max) {
        fail_at(place, fmt::format("expected [smallest, largest], found [{}, {}]", number_text(min), number_text(max)));
    }
    value = {min, max};
}

void read_value(Place const& place, Limits const& limits, Axes& value) {
    value = read_tuple<double, 3>(place, limits, expected_text(limits, value));
}

void read_value(Place const& place, Limits const& limits, std::array<float, 3>& value) {
    value = read_tuple<float, 3>(place, limits, expected_text(limits, value));
}

void read_value(Place const& place, Limits const& limits, std::vector<std::string>& value) {
    if (place.node.kind != Node::Kind::sequence) {
        fail_expected(place, expected_text(limits, value));
    }
    value.clear();
    for (std::size_t i = 0; i < place.node.items.size(); ++i) {
        read_value({place.node.items[i], fmt::format("{}.{}", place.path, i)}, limits, value.emplace_back());
    }
}

void UnitSlips::look_at(Place const& place, Limits const& limits) {
    for (std::size_t i = 0; i < place.node.items.size(); ++i) {
        look_at({place.node.items[i], fmt::format("{}.{}", place.path, i)}, limits);
    }
    std::optional<double> const number = number_of(place.node);
    if (!number || !(limits.range.is_unusually_small(*number) || limits.range.is_unusually_large(*number))) {
        return;
    }
    auto const known = std::ranges::find(slips_, limits.unit, &Slip::unit);
    if (known != slips_.end()) {
        ++known->count;
    } else {
        std::string const where = fmt::format("{}: {}", place.node.where(), shown(place.path));
        slips_.push_back({.unit = limits.unit, .where = where, .text = place.node.scalar, .number = *number});
    }
}

void UnitSlips::warn() const {
    for (Slip const& slip : slips_) {
        auto const similar = std::ranges::find(kSimilarUnits, slip.unit, &SimilarUnit::expected);
        if (similar == kSimilarUnits.end()) {
            continue;
        }
        std::string const others = slip.count == 1 ? ""
                                   : slip.count == 2
                                       ? ", like another number of this list"
                                       : fmt::format(", like {} other numbers of this list", slip.count - 1);
        double const meant = number_from(fmt::format("{:.6g}", slip.number * similar->factor));
        log().warn("{}: {} {} is unusually {}{}; if you meant {}, write {}", slip.where, slip.text, slip.unit,
                   similar->factor > 1.0 ? "small" : "large", others, similar->taken, number_text(meant));
    }
}

void require_integers(Place const& place) {
    for (std::size_t i = 0; i < place.node.items.size(); ++i) {
        require_integers({place.node.items[i], fmt::format("{}.{}", place.path, i)});
    }
    std::optional<double> const number = number_of(place.node);
    if (number && std::trunc(*number) != *number) {
        fail_expected(place, "an integer");
    }
}

void warn_of_slips(Place const& place, Limits const& limits, bool is_integer) {
    std::optional<double> const number = number_of(place.node);
    if (is_integer && number && std::trunc(*number) != *number) {
        log().warn("{}: {}: expected an integer, found {}; {} is used", place.node.where(), shown(place.path),
                   place.node.scalar, number_text(std::trunc(*number)));
        return;
    }
    if (is_integer && place.node.kind == Node::Kind::sequence) {
        for (std::size_t i = 0; i < place.node.items.size(); ++i) {
            warn_of_slips({place.node.items[i], fmt::format("{}.{}", place.path, i)}, limits, is_integer);
        }
        return;
    }
    UnitSlips slips;
    slips.look_at(place, limits);
    slips.warn();
}

std::string expected_text(Limits const& /*limits*/, bool) {
    return "true or false";
}
std::string expected_text(Limits const& limits, int) {
    return expected_integer<int>(limits);
}
std::string expected_text(Limits const& limits, std::int64_t) {
    return expected_integer<std::int64_t>(limits);
}
std::string expected_text(Limits const& limits, std::uint32_t) {
    return expected_integer<std::uint32_t>(limits);
}
std::string expected_text(Limits const& limits, std::uint64_t) {
    return with_unit(limits.range.text().empty() ? "an integer of at least 0" : "an integer" + limits.range.text(),
                     limits.unit);
}
std::string expected_text(Limits const& limits, float) {
    return expected_number(limits);
}
std::string expected_text(Limits const& limits, double) {
    return expected_number(limits);
}
std::string expected_text(Limits const& /*limits*/, std::string const&) {
    return "a string";
}
std::string expected_text(Limits const& limits, Vec2) {
    return with_unit("a list [x, y] of two numbers" + limits.range.text(), limits.unit);
}
std::string expected_text(Limits const& limits, IntRange) {
    return with_unit("a list [smallest, largest] of two integers" + limits.range.text(), limits.unit);
}
std::string expected_text(Limits const& limits, Interval) {
    return with_unit("a list [value] or [smallest, largest] of numbers" + limits.range.text(), limits.unit);
}
std::string expected_text(Limits const& limits, Axes const& /*unused*/) {
    return with_unit("a list [x, y, z] of numbers" + limits.range.text(), limits.unit);
}
std::string expected_text(Limits const& limits, std::array<float, 3> const& /*unused*/) {
    return with_unit("a list of three numbers" + limits.range.text(), limits.unit);
}
std::string expected_text(Limits const& /*limits*/, std::vector<std::string> const&) {
    return "a list of names";
}

std::string value_text(bool value) {
    return value ? "true" : "false";
}
std::string value_text(int value) {
    return std::to_string(value);
}
std::string value_text(std::int64_t value) {
    return std::to_string(value);
}
std::string value_text(std::uint32_t value) {
    return std::to_string(value);
}
std::string value_text(std::uint64_t value) {
    return std::to_string(value);
}
std::string value_text(float value) {
    return std::isfinite(value) ? fmt::format("{:g}", value) : number_text(value);
}
std::string value_text(double value) {
    return number_text(value);
}
std::string value_text(std::string const& value) {
    return fmt::format("\"{}\"", value);
}
std::string value_text(Vec2 value) {
    return fmt::format("[{}, {}]", value_text(value.x), value_text(value.y));
}
std::string value_text(IntRange value) {
    return fmt::format("[{}, {}]", value.min, value.max);
}
std::string value_text(Interval value) {
    return value.min == value.max ? fmt::format("[{}]", number_text(value.min))
                                  : fmt::format("[{}, {}]", number_text(value.min), number_text(value.max));
}
std::string value_text(Axes const& value) {
    return fmt::format("[{:g}]", fmt::join(value, ", "));
}
std::string value_text(std::array<float, 3> const& value) {
    return fmt::format("[{:g}]", fmt::join(value, ", "));
}
std::string value_text(std::vector<std::string> const& value) {
    return fmt::format("[{}]", fmt::join(value, ", "));
}

Node plain_node(std::string text) {
    Node node;
    node.kind = Node::Kind::scalar;
    node.scalar = std::move(text);
    return node;
}

Node value_node(bool value) {
    return plain_node(value_text(value));
}
Node value_node(int value) {
    return plain_node(value_text(value));
}
Node value_node(std::int64_t value) {
    return plain_node(value_text(value));
}
Node value_node(std::uint32_t value) {
    return plain_node(value_text(value));
}
Node value_node(std::uint64_t value) {
    return plain_node(value_text(value));
}
Node value_node(float value) {
    return plain_node(shortest_text(value));
}
Node value_node(double value) {
    return plain_node(shortest_text(value));
}
Node value_node(std::string const& value) {
    Node node = plain_node(value);
    node.quoted = true;
    return node;
}
Node value_node(Vec2 value) {
    return sequence(std::array{value.x, value.y});
}
Node value_node(IntRange value) {
    return sequence(std::array{value.min, value.max});
}
Node value_node(Interval value) {
    return value.min == value.max ? sequence(std::array{value.min}) : sequence(std::array{value.min, value.max});
}
Node value_node(Axes const& value) {
    return sequence(value);
}
Node value_node(std::array<float, 3> const& value) {
    return sequence(value);
}
Node value_node(std::vector<std::string> const& value) {
    return sequence(value);
}

}  // namespace pogosim
