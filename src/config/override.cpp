// `--set key.path=value`.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "config/tree.hpp"

namespace pogosim {

namespace {

constexpr auto kSource = kSetSource;

/// A value on the command line has no line number.
void forget_lines(Node& node) {
    node.source = kSource;
    node.line = 0;
    for (auto& [key, value] : node.entries) {
        forget_lines(value);
    }
    std::ranges::for_each(node.items, forget_lines);
}

/// The node one step further down the path; missing maps are created.
Node& step_into(Node& parent, std::string const& key, std::string const& assignment) {
    if (Node* child = child_at(parent, key)) {
        return *child;
    }
    if (parent.kind == Node::Kind::sequence) {
        throw ConfigError(
            fmt::format("{} '{}': '{}' is not an index of the list of length {} at {}; the first one is 0", kSource,
                        assignment, key, parent.items.size(), parent.where()));
    }
    if (parent.kind == Node::Kind::scalar) {
        throw ConfigError(fmt::format("{} '{}': '{}' would be inside the single value '{}' ({})", kSource, assignment,
                                      key, parent.scalar, parent.where()));
    }
    parent.kind = Node::Kind::map;
    Node& made = parent.entries.emplace_back(key, Node{}).value;
    made.source = kSource;
    return made;
}

Node& make_path(Node& root, std::string_view dotted_path, std::string const& assignment) {
    Node* node = &root;
    for (std::size_t depth = 0; depth < kMaxDepth; ++depth) {
        if (Node* exact = node->find(dotted_path)) {
            return *exact;
        }
        SplitPath const path = split_path(dotted_path);
        if (path.first.empty()) {
            throw ConfigError(fmt::format("{} '{}': a name in the key path is empty", kSource, assignment));
        }
        node = &step_into(*node, path.first, assignment);
        if (path.last) {
            return *node;
        }
        dotted_path = path.rest;
    }
    throw ConfigError(fmt::format("{}: the key path has more than {} names", kSource, kMaxDepth));
}

}  // namespace

void apply_override(Node& root, std::string const& assignment) {
    std::size_t const equals = assignment.find('=');
    if (equals == std::string::npos) {
        throw ConfigError(fmt::format("{} '{}': expected key.path=value", kSource, assignment));
    }
    Node value = parse_yaml(assignment.substr(equals + 1), fmt::format("{} '{}'", kSource, assignment));
    if (value.blank) {
        throw ConfigError(fmt::format("{} '{}': nothing stands behind '='; for the default, write {}=null", kSource,
                                      assignment, assignment.substr(0, equals)));
    }
    forget_lines(value);
    make_path(root, assignment.substr(0, equals), assignment) = std::move(value);
    if (size_of(root).depth > kMaxDepth) {
        throw ConfigError(fmt::format("{} '{}': nested deeper than {} levels", kSource, assignment, kMaxDepth));
    }
}

}  // namespace pogosim
