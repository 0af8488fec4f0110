// Resolves batch options, hierarchical alternatives and optimisation domains for a single run.
#include <algorithm>
#include <string>
#include <string_view>

#include "base/log.hpp"
#include "config/check_options.hpp"
#include "config/option_keys.hpp"
#include "config/tree.hpp"

namespace pogosim {

namespace {

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
    nothing.scalar = "options without default_option";
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

Node resolved_at(Node const& node, std::string const& path) {
    if (node.find(kHierarchicalOptions) != nullptr) {
        return resolved_at(with_default_alternative(node), path);
    }
    if (offers_options(node)) {
        refuse_other_keys(node, path);  // which an alternative may have brought
        return resolved_at(chosen_option(node), path);
    }
    Node resolved = node;
    for (auto& [key, value] : resolved.entries) {
        value = resolved_at(value, path.empty() ? key : path + "." + key);
    }
    for (std::size_t i = 0; i < resolved.items.size(); ++i) {
        resolved.items[i] = resolved_at(resolved.items[i], path + "." + std::to_string(i));
    }
    return resolved;
}

}  // namespace

Node resolve_options(Node const& node) {
    return resolved_at(node, "");
}

}  // namespace pogosim
