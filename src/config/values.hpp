// Converts one node to one value: numbers, booleans, strings, pairs and lists, all checked, with the place of errors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/vec2.hpp"
#include "config/range.hpp"
#include "config/tree.hpp"
#include "world/magnetometer_spec.hpp"
#include "world/specs.hpp"

namespace pogosim {

/// A value of the configuration: the node and its key path ("objects.robots.nb").
struct Place {
    Node const& node;
    std::string path;
};

/// The range of a number. The unit is for messages and documentation.
struct Limits {
    Range range = {};
    std::string_view unit = {};
};

/// Throws KeyError "file:line: path: expected <expected>, found <the value>".
[[noreturn]] void fail_expected(Place const& place, std::string_view expected);

/// Throws KeyError "file:line: path: <what>".
[[noreturn]] void fail_at(Place const& place, std::string_view what);

/// Whether a null node stands for options of a batch, none of which is for a single run. Its scalar says so.
bool is_open_option(Node const& node);

/// The value of a node, for messages: "-3", "'many'", "a list".
std::string found_text(Node const& node);

/// Converts ASCII letters to lower case.
std::string lower_case(std::string text);

/// A user's string for a message: without line breaks, truncated if long.
std::string shown(std::string_view text);

/// Decimal ("12", "1.0e6", ".5"), hexadecimal ("0x1F") and octal ("0o17") numbers, ".inf", ".nan". Quotes do not
/// matter: some tools write 1.0e6 as a string.
std::optional<double> number_of(Node const& node);

/// true, false, yes, no, on, off in any case, 1 and 0.
std::optional<bool> truth_of(Node const& node);

/// read_value: the node as a value of that type, or ConfigError. Integers drop the fraction of a number.
void read_value(Place const& place, Limits const& limits, bool& value);
void read_value(Place const& place, Limits const& limits, int& value);
void read_value(Place const& place, Limits const& limits, std::int64_t& value);
void read_value(Place const& place, Limits const& limits, std::uint32_t& value);
void read_value(Place const& place, Limits const& limits, std::uint64_t& value);
void read_value(Place const& place, Limits const& limits, float& value);
void read_value(Place const& place, Limits const& limits, double& value);
void read_value(Place const& place, Limits const& limits, std::string& value);
void read_value(Place const& place, Limits const& limits, Vec2& value);
void read_value(Place const& place, Limits const& limits, IntRange& value);
void read_value(Place const& place, Limits const& limits, Interval& value);
void read_value(Place const& place, Limits const& limits, Axes& value);
void read_value(Place const& place, Limits const& limits, std::array<float, 3>& value);
void read_value(Place const& place, Limits const& limits, std::vector<std::string>& value);

template <class T>
void read_value(Place const& place, Limits const& limits, std::optional<T>& value) {
    read_value(place, limits, value.emplace());
}

/// Numbers that look like another unit than that of their limits (Range::usual_min, usual_max). However many there are
/// in a list: one warning for each unit, with the first place.
class UnitSlips {
public:
    /// Takes the number, or the numbers of a list.
    void look_at(Place const& place, Limits const& limits);
    void warn() const;

private:
    struct Slip {
        std::string_view unit;
        std::string where;  // of the first one
        std::string text;
        double number = 0.0;
        std::size_t count = 1;
    };
    std::vector<Slip> slips_;
};

/// Throws ConfigError for a number, or one of a list, that is not whole.
void require_integers(Place const& place);

/// Warns of numbers, at a node that has been read, that are not taken as written: fractions that are cut
/// (`is_integer`), and what looks like another unit.
void warn_of_slips(Place const& place, Limits const& limits, bool is_integer);

/// Whether numbers are read into T as integers.
template <class T>
inline constexpr bool kReadsIntegers =
    std::is_same_v<T, int> || std::is_same_v<T, std::int64_t> || std::is_same_v<T, std::uint32_t> ||
    std::is_same_v<T, std::optional<std::uint32_t>> || std::is_same_v<T, std::optional<std::uint64_t>> ||
    std::is_same_v<T, IntRange>;

/// expected_text: what a key of that type takes, "a number above 0 (mm)".
std::string expected_text(Limits const& limits, bool);
std::string expected_text(Limits const& limits, int);
std::string expected_text(Limits const& limits, std::int64_t);
std::string expected_text(Limits const& limits, std::uint32_t);
std::string expected_text(Limits const& limits, std::uint64_t);
std::string expected_text(Limits const& limits, float);
std::string expected_text(Limits const& limits, double);
std::string expected_text(Limits const& limits, std::string const&);
std::string expected_text(Limits const& limits, Vec2);
std::string expected_text(Limits const& limits, IntRange);
std::string expected_text(Limits const& limits, Interval);
std::string expected_text(Limits const& limits, Axes const&);
std::string expected_text(Limits const& limits, std::array<float, 3> const&);
std::string expected_text(Limits const& limits, std::vector<std::string> const&);

template <class T>
std::string expected_text(Limits const& limits, std::optional<T> const&) {
    return expected_text(limits, T{});
}

/// value_text: a value as YAML.
std::string value_text(bool value);
std::string value_text(int value);
std::string value_text(std::int64_t value);
std::string value_text(std::uint32_t value);
std::string value_text(std::uint64_t value);
std::string value_text(float value);
std::string value_text(double value);
std::string value_text(std::string const& value);
std::string value_text(Vec2 value);
std::string value_text(IntRange value);
std::string value_text(Interval value);
std::string value_text(Axes const& value);
std::string value_text(std::array<float, 3> const& value);
std::string value_text(std::vector<std::string> const& value);

template <class T>
std::string value_text(std::optional<T> const& value) {
    return value ? value_text(*value) : "";
}

/// A word or number that needs no quotes.
Node plain_node(std::string text);

/// value_node: a value as a node that is read back as exactly this value; null for one that is absent.
Node value_node(bool value);
Node value_node(int value);
Node value_node(std::int64_t value);
Node value_node(std::uint32_t value);
Node value_node(std::uint64_t value);
Node value_node(float value);
Node value_node(double value);
Node value_node(std::string const& value);
Node value_node(Vec2 value);
Node value_node(IntRange value);
Node value_node(Interval value);
Node value_node(Axes const& value);
Node value_node(std::array<float, 3> const& value);
Node value_node(std::vector<std::string> const& value);

template <class T>
Node value_node(std::optional<T> const& value) {
    return value ? value_node(*value) : Node();
}

}  // namespace pogosim
