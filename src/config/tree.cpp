#include "config/tree.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "config/dotted_path.hpp"

namespace pogosim {

Node const* Node::find(std::string_view key) const {
    auto const found = std::ranges::find(entries, key, [](auto const& entry) { return std::string_view(entry.key); });
    return found == entries.end() ? nullptr : &found->value;
}

Node* Node::find(std::string_view key) {
    return const_cast<Node*>(std::as_const(*this).find(key));
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
    if (parent.kind != Node::Kind::sequence) {
        return parent.find(key);
    }
    std::size_t index = 0;
    auto const [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    bool const is_index = error == std::errc() && end == key.data() + key.size() && index < parent.items.size();
    return is_index ? &parent.items[index] : nullptr;
}

Node* child_at(Node& parent, std::string_view key) {
    return const_cast<Node*>(child_at(std::as_const(parent), key));
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
