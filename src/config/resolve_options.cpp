// What a single run makes of batch options, hierarchical alternatives and optimisation domains.
#include <algorithm>
#include <array>
#include <string_view>

#include "base/log.hpp"
#include "config/tree.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kHierarchical = "batch_hierarchical_options";
constexpr std::string_view kDefaultAlternative = "default";
constexpr std::string_view kDefaultOption = "default_option";
constexpr std::string_view kDomain = "optimization_domain";
constexpr std::array kOptionKeys{kDefaultOption, std::string_view("batch_options"),
                                 std::string_view("batch_options_range"), kDomain};

bool offers_options(Node const& map) {
    return std::ranges::any_of(kOptionKeys, [&map](std::string_view key) { return map.find(key) != nullptr; });
}

/// `default_option`; without it the point an optimisation starts from; without that nothing, so that the default of
/// the key holds.
Node chosen_option(Node const& map) {
    if (Node const* option = map.find(kDefaultOption)) {
        return *option;
    }
    Node const* domain = map.find(kDomain);
    Node const* start = domain == nullptr ? nullptr : domain->find("init");
    if (start != nullptr) {
        return *start;
    }
    Node nothing;
    nothing.source = map.source;
    nothing.line = map.line;
    return nothing;
}

/// Maps are merged key by key, anything else is replaced.
void overlay(Node& map, Node const& upper) {
    for (auto const& [key, value] : upper.entries) {
        Node* below = map.find(key);
        if (below == nullptr) {
            map.entries.emplace_back(key, value);
        } else if (below->kind == Node::Kind::map && value.kind == Node::Kind::map && !offers_options(*below)) {
            overlay(*below, value);
        } else {
            *below = value;
        }
    }
}

Node with_default_alternative(Node map) {
    Node const alternatives = *map.find(kHierarchical);
    std::erase_if(map.entries, [](auto const& entry) { return entry.key == kHierarchical; });
    Node const* chosen = alternatives.find(kDefaultAlternative);
    if (chosen == nullptr || chosen->kind != Node::Kind::map) {
        log().warn("{}: '{}' has no map '{}'; a single run uses none of its alternatives", alternatives.where(),
                   kHierarchical, kDefaultAlternative);
        return map;
    }
    overlay(map, *chosen);
    return map;
}

}  // namespace

Node resolve_options(Node const& node) {
    if (node.find(kHierarchical) != nullptr) {
        return resolve_options(with_default_alternative(node));
    }
    if (offers_options(node)) {
        return resolve_options(chosen_option(node));
    }
    Node resolved = node;
    for (auto& [key, value] : resolved.entries) {
        value = resolve_options(value);
    }
    for (Node& item : resolved.items) {
        item = resolve_options(item);
    }
    return resolved;
}

}  // namespace pogosim
