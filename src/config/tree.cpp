#include "config/tree.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

namespace pogosim {

namespace {

// Node const* of a Node const, Node* of a Node.

template <class AnyNode>
auto* find_in(AnyNode& map, std::string_view key) {
    auto const found =
        std::ranges::find(map.entries, key, [](auto const& entry) { return std::string_view(entry.key); });
    return found == map.entries.end() ? nullptr : &found->value;
}

template <class AnyNode>
AnyNode* child_of(AnyNode& parent, std::string_view key) {
    if (parent.kind != Node::Kind::sequence) {
        return parent.find(key);
    }
    std::size_t index = 0;
    auto const [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    bool const is_index = error == std::errc() && end == key.data() + key.size() && index < parent.items.size();
    return is_index ? &parent.items[index] : nullptr;
}

}  // namespace

Node const* Node::find(std::string_view key) const {
    return find_in(*this, key);
}
Node* Node::find(std::string_view key) {
    return find_in(*this, key);
}

std::string Node::where() const {
    return line > 0 ? source + ":" + std::to_string(line) : source;
}

SplitPath split_path(std::string_view dotted_path) {
    SplitPath split;
    for (std::size_t i = 0; i < dotted_path.size(); ++i) {
        if (dotted_path[i] == '.') {
            split.rest = dotted_path.substr(i + 1);
            split.last = false;
            break;
        }
        if (dotted_path.substr(i, 2) == "\\.") {
            ++i;
        }
        split.first += dotted_path[i];
    }
    return split;
}

Node const* child_at(Node const& parent, std::string_view key) {
    return child_of(parent, key);
}
Node* child_at(Node& parent, std::string_view key) {
    return child_of(parent, key);
}

Node const* find_path(Node const& root, std::string_view dotted_path) {
    if (Node const* exact = root.find(dotted_path)) {
        return exact;
    }
    SplitPath const path = split_path(dotted_path);
    Node const* child = child_at(root, path.first);
    return child == nullptr || path.last ? child : find_path(*child, path.rest);
}

}  // namespace pogosim
