#include "config/user_parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "config/option_keys.hpp"
#include "config/source.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

constexpr Limits kAnyNumber{.range = any().or_infinity().or_nan()};

std::string path_of(std::string const& name) {
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

/// A value of which the program reads only the beginning.
void warn_of_rest(Place const& place, std::string_view what, std::size_t found, std::size_t most) {
    log().warn("{}: {}: the program has room for {}, found {}; the rest is ignored", place.node.where(),
               shown(place.path), counted(most, what), found);
}

}  // namespace

UserParameters::UserParameters(Scenario const& scenario) {
    if (Node const* const written = source_of(scenario).tree.find("parameters")) {
        parameters_ = *written;
    }
}

UserParameters UserParameters::with(std::string const& name, std::string const& yaml_value) const {
    Node changed = parameters_;
    apply_override(changed, fmt::format("{}={}", name, yaml_value));
    return UserParameters(std::move(changed));
}

Node const* UserParameters::ask(std::string const& name) {
    Node const* const node = find_path(parameters_, name);
    if (node != nullptr) {
        bool const is_first = read_.insert(node).second;
        if (node->blank && is_first) {
            log().warn("{}: {}: expected a value, found {}; the program keeps its own", node->where(),
                       shown(path_of(name)), node->scalar.empty() ? "nothing" : node->scalar);
        }
    } else if (std::ranges::find(missed_, name) == missed_.end()) {
        missed_.push_back(name);
    }
    return node == nullptr || node->kind == Node::Kind::null ? nullptr : node;
}

template <class T>
std::optional<T> UserParameters::read(std::string const& name, Range const& range) {
    std::optional<T> value;
    if (Node const* const node = ask(name)) {
        read_value({*node, path_of(name)}, {.range = range}, value);
    }
    return value;
}

std::optional<bool> UserParameters::boolean(std::string const& name) {
    return read<bool>(name, {});
}

std::optional<double> UserParameters::number(std::string const& name, double largest) {
    Node const* const node = ask(name);
    return node == nullptr ? std::nullopt : std::optional(read_number({*node, path_of(name)}, largest));
}

std::optional<std::int64_t> UserParameters::integer(std::string const& name, std::int64_t min, std::int64_t max) {
    std::size_t const read_before = read_.size();
    auto const value = read<std::int64_t>(name, between(static_cast<double>(min), static_cast<double>(max)));
    if (value && read_.size() > read_before) {
        warn_of_slips({*find_path(parameters_, name), path_of(name)}, {}, /*is_integer=*/true);
    }
    return value;
}

std::optional<std::string> UserParameters::text(std::string const& name, std::size_t most) {
    std::size_t const read_before = read_.size();
    auto text = read<std::string>(name, {});
    if (text && text->size() > most) {
        if (read_.size() > read_before) {
            warn_of_rest({*find_path(parameters_, name), path_of(name)}, "character", text->size(), most);
        }
        text->resize(most);
    }
    return text;
}

std::optional<std::vector<double>> UserParameters::numbers(std::string const& name, std::size_t size, double largest) {
    std::size_t const read_before = read_.size();
    Node const* const node = ask(name);
    if (node == nullptr || (node->kind == Node::Kind::sequence && node->items.empty())) {
        return std::nullopt;
    }
    Place const place{*node, path_of(name)};
    if (node->kind != Node::Kind::sequence) {
        fail_expected(place, fmt::format("a list of at least {} numbers", size));
    }
    if (node->items.size() < size) {
        fail_at(place, fmt::format("expected a list of at least {} numbers, found {}", size, node->items.size()));
    }
    if (node->items.size() > size && read_.size() > read_before) {
        warn_of_rest(place, "number", node->items.size(), size);
    }
    std::vector<double> numbers(size);
    for (std::size_t i = 0; i < size; ++i) {
        numbers[i] = read_number({node->items[i], fmt::format("{}.{}", place.path, i)}, largest);
    }
    return numbers;
}

void UserParameters::refuse(std::string const& name, std::string const& expected) {
    Node const* const node = find_path(parameters_, name);
    if (node == nullptr || node->kind == Node::Kind::null) {
        throw ConfigError(fmt::format("{}: expected {}, found the program's own default", path_of(name), expected));
    }
    fail_expected({*node, path_of(name)}, expected);
}

void UserParameters::check_range(std::string const& name, double value, double min, double max) {
    Range const range = between(min, max);
    if (!range.contains(value)) {
        refuse(name, "a number" + range.text());
    }
}

std::string UserParameters::unread() const {
    std::vector<Unread> unread;
    collect_unread(parameters_, "", unread);
    std::vector<std::string> nearest;
    for (auto const& [path, node] : unread) {
        nearest.push_back(did_you_mean(shown(path), missed_));
    }
    std::vector<std::string> texts;
    for (auto const& [path, node] : unread) {
        std::string hint = nearest[texts.size()];
        if (std::ranges::count(nearest, hint) > 1) {
            hint.clear();  // a name that is near to several keys is no slip of theirs
        }
        if (auto const word = misspelt_option(std::string_view(path).substr(path.rfind('.') + 1)); !word.empty()) {
            hint = fmt::format("; did you mean '{}'?", word);
        }
        texts.push_back(fmt::format("{} ({}{})", shown(path), node->where(), hint));
    }
    return fmt::format("{}", fmt::join(texts, ", "));
}

bool UserParameters::any_part_was_read(Node const& node) const {
    auto const is_read = [this](Node const& part) { return any_part_was_read(part); };
    return read_.contains(&node) || std::ranges::any_of(node.items, is_read) ||
           std::ranges::any_of(node.entries, [&](auto const& entry) { return is_read(entry.value); });
}

void UserParameters::collect_unread(Node const& node, std::string const& path, std::vector<Unread>& unread) const {
    bool const is_list = !node.items.empty();  // read as a whole
    if (read_.contains(&node) || (is_list && any_part_was_read(node))) {
        return;
    }
    for (auto const& [key, value] : node.entries) {
        collect_unread(value, path.empty() ? key : fmt::format("{}.{}", path, key), unread);
    }
    if (node.entries.empty() && &node != &parameters_) {
        unread.push_back({path, &node});
    }
}

}  // namespace pogosim
