#include "config/user_parameters.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

constexpr Limits kAnyNumber{.range = any().or_infinity().or_nan()};

std::string path_of(std::string_view name) {
    return fmt::format("parameters.{}", name);
}

double read_number(Place const& place, double largest) {
    double value = 0.0;
    read_value(place, kAnyNumber, value);
    if (std::isfinite(value) && std::abs(value) > largest) {
        fail_expected(place, fmt::format("a number from {0} to {1}", number_text(-largest), number_text(largest)));
    }
    return value;
}

template <class T>
std::optional<T> read_parameter(Node const& parameters, std::string_view name, Limits const& limits) {
    std::optional<T> value;
    Node const* node = find_path(parameters, name);
    if (node != nullptr && node->kind != Node::Kind::null) {
        read_value({*node, path_of(name)}, limits, value);
    }
    return value;
}

}  // namespace

std::optional<bool> bool_parameter(Node const& parameters, std::string_view name) {
    return read_parameter<bool>(parameters, name, {});
}

std::optional<double> number_parameter(Node const& parameters, std::string_view name, double largest) {
    Node const* node = find_path(parameters, name);
    if (node == nullptr || node->kind == Node::Kind::null) {
        return std::nullopt;
    }
    return read_number({*node, path_of(name)}, largest);
}

std::optional<std::int64_t> integer_parameter(Node const& parameters, std::string_view name, std::int64_t min,
                                              std::int64_t max) {
    Limits const limits{.range = between(static_cast<double>(min), static_cast<double>(max))};
    return read_parameter<std::int64_t>(parameters, name, limits);
}

std::optional<std::string> text_parameter(Node const& parameters, std::string_view name) {
    return read_parameter<std::string>(parameters, name, {});
}

std::optional<std::vector<double>> numbers_parameter(Node const& parameters, std::string_view name, std::size_t size,
                                                     double largest) {
    Node const* node = find_path(parameters, name);
    if (node == nullptr || node->kind == Node::Kind::null ||
        (node->kind == Node::Kind::sequence && node->items.empty())) {
        return std::nullopt;
    }
    if (node->kind != Node::Kind::sequence) {
        fail_expected({*node, path_of(name)}, fmt::format("a list of at least {} numbers", size));
    }
    if (node->items.size() < size) {
        fail_at({*node, path_of(name)},
                fmt::format("expected a list of at least {} numbers, found {}", size, node->items.size()));
    }
    std::vector<double> numbers(size);
    for (std::size_t i = 0; i < size; ++i) {
        numbers[i] = read_number({node->items[i], fmt::format("{}.{}", path_of(name), i)}, largest);
    }
    return numbers;
}

void refuse_parameter(Node const& parameters, std::string_view name, std::string_view expected) {
    Node const* const node = find_path(parameters, name);
    if (node == nullptr || node->kind == Node::Kind::null) {
        throw ConfigError(fmt::format("{}: expected {}, found the program's own default", path_of(name), expected));
    }
    fail_expected({*node, path_of(name)}, expected);
}

void check_parameter_range(Node const& parameters, std::string_view name, double value, Range const& range) {
    if (!range.contains(value)) {
        refuse_parameter(parameters, name, "a number" + range.text());
    }
}

}  // namespace pogosim
