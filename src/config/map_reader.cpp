#include "config/map_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "config/misplaced_keys.hpp"
#include "config/option_keys.hpp"

namespace pogosim {

namespace {

/// ".robots.nb" of a value that is a chain of maps down to it, as --set makes them.
std::string path_inside(Node const& value) {
    bool const is_chain = value.kind == Node::Kind::map && value.entries.size() == 1;
    return is_chain ? "." + value.entries.front().key + path_inside(value.entries.front().value) : "";
}

/// A hint for a key at the top level that is one level further in as well.
std::string inner_place(Node const& root, std::string const& key, Node const& value) {
    for (char const* const outer : {"objects", "parameters"}) {
        Node const* const map = root.find(outer);
        if (map != nullptr && map->find(key) != nullptr) {
            return fmt::format("; did you mean '{}.{}'?", outer, shown(key + path_inside(value)));
        }
    }
    return "";
}

/// A hint for a category at the top level.
std::string place_of_category(std::string const& key, Node const& value) {
    bool const is_category = value.kind == Node::Kind::map && value.find("type") != nullptr;
    return is_category ? fmt::format("; did you mean 'objects.{}'?", shown(key)) : "";
}

}  // namespace

std::string names_text(std::vector<std::string> const& names) {
    return names.size() <= 2 ? fmt::format("{}", fmt::join(names, " or "))
                             : fmt::format("one of {}", fmt::join(names, ", "));
}

MapReader::MapReader(Node const& map, std::string path, Reading& reading)
    : map_(map), path_(std::move(path)), reading_(reading) {
    if (map.kind != Node::Kind::map && map.kind != Node::Kind::null) {
        fail_expected(place(), "a map of keys");
    }
    values_.kind = Node::Kind::map;
}

void MapReader::set_value(std::string_view key, Node value) {
    if (value.kind == Node::Kind::null) {
        return;
    }
    if (Node* const earlier = values_.find(key)) {
        *earlier = std::move(value);
    } else {
        values_.entries.emplace_back(std::string(key), std::move(value));
    }
}

Node const* MapReader::find(std::string_view key) const {
    Node const* value = map_.find(key);
    return value == nullptr || value->kind == Node::Kind::null ? nullptr : value;
}

std::optional<MapReader::LoneKey> MapReader::lone_key(std::string_view one, std::string_view other) const {
    bool const has_one = find(one) != nullptr;
    if (has_one == (find(other) != nullptr)) {
        return std::nullopt;
    }
    return has_one ? LoneKey{one, other} : LoneKey{other, one};
}

void MapReader::add_map(std::string_view key, MapReader const& inner) {
    KeyDescription map;
    map.name = key;
    map.expected = kMapOfKeysBelow;
    map.doc = fmt::format("See the keys {}.* below.", key);
    known_.push_back(std::move(map));
    for (KeyDescription description : inner.known_) {
        description.name = fmt::format("{}.{}", key, description.name);
        description.required = false;  // in the map alone, where it has been asked for
        known_.push_back(std::move(description));
    }
    if (!inner.values_.entries.empty()) {
        set_value(key, inner.values_);
    }
}

void MapReader::refuse(std::string_view key, std::string const& what) const {
    if (!reading_.problems.has_key(path_of(key))) {
        collect([&] { fail_at({*find(key), path_of(key)}, what); });
    }
}

void MapReader::look_for_slips(Place const& place, Limits const& limits, bool is_integer) const {
    if (is_integer && reading_.strict_values) {
        require_integers(place);
    }
    warn_of_slips(place, limits, is_integer);
}

std::string MapReader::path_of(std::string_view key) const {
    return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

std::optional<std::size_t> MapReader::pick(Place const& place, std::vector<std::string> const& names,
                                           ChoiceRule const& rule, std::string const& default_name) const {
    Node const& node = place.node;
    std::string const typed = rule.any_case ? lower_case(node.scalar) : node.scalar;
    auto const found = std::ranges::find(names, typed);
    if (node.kind == Node::Kind::scalar && found != names.end()) {
        return static_cast<std::size_t>(found - names.begin());
    }
    if (node.kind == Node::Kind::null && default_name.empty()) {
        return std::nullopt;  // a required key: refused as missing later
    }
    if (node.blank) {
        return std::nullopt;  // finish() warns
    }
    bool const is_null = node.kind == Node::Kind::null || (node.kind == Node::Kind::scalar && typed == "null");
    bool const only_warns = is_null || (rule.warns_only && node.kind == Node::Kind::scalar && !reading_.strict_values);
    std::string const complaint = fmt::format("expected {}, found {}", names_text(names), found_text(node));
    if (default_name.empty() || !only_warns) {
        fail_at(place, complaint + did_you_mean(shown(typed), names));
    }
    log().warn("{}: {}: {}; '{}' is used{}", node.where(), place.path, complaint, default_name,
               did_you_mean(shown(typed), names));
    return std::nullopt;
}

std::optional<double> MapReader::number_or_word(Place const& place, Limits const& limits, std::string_view word,
                                                std::string_view expected) {
    if (place.node.kind == Node::Kind::scalar && place.node.scalar == word) {
        return std::nullopt;
    }
    std::optional<double> const number = number_of(place.node);
    if (!number || !limits.range.contains(*number)) {
        fail_expected(place, expected);
    }
    return number;
}

void MapReader::refuse_both_names(std::string_view name, std::string_view other_name) const {
    Node const* const value = find(name);
    if (!other_name.empty() && value != nullptr && find(other_name) != nullptr) {
        fail_at({*value, path_of(name)}, fmt::format("is an alias of {}; use one or the other", other_name));
    }
}

void MapReader::refuse_missing_keys() const {
    for (KeyDescription const& key : known_) {
        if (!key.required || find(key.name) != nullptr) {
            continue;
        }
        Node const* const node = map_.find(key.name);
        if (node != nullptr && is_open_option(*node)) {
            collect([&] { fail_at({*node, path_of(key.name)}, node->scalar); });
        } else {
            collect(
                [&] { fail_at(place(), fmt::format("the key '{}' is missing; expected {}", key.name, key.expected)); });
        }
    }
}

void MapReader::report_unknown(std::string const& key, Node const& value) const {
    std::vector<std::string> names;
    std::ranges::transform(known_, std::back_inserter(names), &KeyDescription::name);
    std::string const path = shown(path_of(key));
    std::string hint = new_place(path);
    if (hint.empty() && path_.empty()) {
        hint = inner_place(map_, key, value);
    }
    if (hint.empty()) {
        hint = other_level(path_, key, map_, reading_.types);
    }
    if (hint.empty()) {
        hint = inner_level(path_, key, names);
    }
    if (hint.empty() && path_.empty()) {
        hint = place_of_category(key, value);
    }
    if (hint.empty()) {
        hint = did_you_mean(shown(key), names);
    }
    if (reading_.strict_keys || (reading_.strict_overrides && value.source == kSetSource)) {
        reading_.problems.add(fmt::format("{}: unknown key '{}'{}{}", value.where(), path, hint,
                                          reading_.strict_keys ? " (--strict)" : ""));
        return;
    }
    log().warn("{}: unknown key '{}' is ignored{}", value.where(), path, hint);
}

void MapReader::report_blank(KeyDescription const& key, Node const& value) const {
    bool const is_option = is_open_option(value);
    std::string const problem =
        fmt::format("{}: {}: {}", value.where(), shown(path_of(key.name)),
                    is_option ? value.scalar : fmt::format("expected {}, found nothing", key.expected));
    std::string const value_of_default = key.default_text.empty() ? "" : ", " + key.default_text;
    if (is_option && reading_.strict_values) {
        reading_.problems.add(problem);
    } else if (!is_option && reading_.strict_keys) {
        reading_.problems.add(problem + "; write null for the default (--strict)");
    } else if (is_option) {
        log().warn("{} (a single run takes the default{})", problem, value_of_default);
    } else {
        log().warn("{}; the default is used{}", problem, value_of_default);
    }
}

void MapReader::finish(std::vector<std::string> const& ignored) const {
    refuse_missing_keys();
    for (auto const& [key, value] : map_.entries) {
        auto const known = std::ranges::find(known_, key, &KeyDescription::name);
        if (known != known_.end()) {
            if (value.blank && known->warns_of_blank) {
                report_blank(*known, value);
            }
        } else if (key != kBatchChoices && std::ranges::find(ignored, key) == ignored.end()) {
            report_unknown(key, value);
        }
    }
}

}  // namespace pogosim
