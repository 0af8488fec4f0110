// Resolves batch options, hierarchical alternatives and optimisation domains for a single run.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "base/log.hpp"
#include "config/option_keys.hpp"
#include "config/tree.hpp"

namespace pogosim {

namespace {

/// What is said where a single run cannot take any of the options.
std::string why_open(Node const& map) {
    if (map.find(kBatchOptions) == nullptr && map.find(kBatchRange) == nullptr) {
        return fmt::format("has {} but neither {} nor init; run it with pogoptim", kOptimizationDomain, kDefaultOption);
    }
    return fmt::format("has {} but no {}; run it with pogobatch",
                       map.find(kBatchOptions) != nullptr ? kBatchOptions : kBatchRange, kDefaultOption);
}

/// `default_option`, or else the point from which an optimisation starts, or else nothing, so that the default of the
/// key holds.
Node chosen_option(Node const& map) {
    if (Node const* option = map.find(kDefaultOption)) {
        return *option;
    }
    Node const* domain = map.find(kOptimizationDomain);
    Node const* start = domain == nullptr ? nullptr : domain->find("init");
    if (start != nullptr) {
        return *start;
    }
    Node nothing;
    nothing.blank = true;
    nothing.scalar = why_open(map);
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
    Node const alternatives = *map.find(kHierarchicalOptions);
    std::erase_if(map.entries, [](auto const& entry) { return entry.key == kHierarchicalOptions; });
    Node const* chosen = alternatives.find(kDefaultAlternative);
    if (chosen == nullptr || chosen->kind != Node::Kind::map) {
        log().warn("{}: '{}' has no map '{}'; a single run uses none of its alternatives", alternatives.where(),
                   kHierarchicalOptions, kDefaultAlternative);
        return map;
    }
    overlay(map, *chosen);
    return map;
}

Node resolved_at(Node const& node, std::string const& path, Problems& problems) {
    if (node.find(kHierarchicalOptions) != nullptr) {
        return resolved_at(with_default_alternative(node), path, problems);
    }
    if (offers_options(node)) {
        problems.collect([&] { refuse_other_keys(node, path); });  // which an alternative may have brought
        return resolved_at(chosen_option(node), path, problems);
    }
    Node resolved = node;
    for (auto& [key, value] : resolved.entries) {
        value = resolved_at(value, path.empty() ? key : path + "." + key, problems);
    }
    for (std::size_t i = 0; i < resolved.items.size(); ++i) {
        resolved.items[i] = resolved_at(resolved.items[i], path + "." + std::to_string(i), problems);
    }
    return resolved;
}

}  // namespace

Node resolve_options(Node const& node, Problems& problems) {
    return resolved_at(node, "", problems);
}

}  // namespace pogosim
