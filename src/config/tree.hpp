// A configuration as it was written: an ordered tree of plain values, each knowing the file and line it came from.
// Nothing here depends on the YAML library.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pogosim {

class Problems;

/// Source of the nodes that apply_override() makes.
inline constexpr char const* kSetSource = "--set";

/// One YAML node.
struct Node {
    enum class Kind { null, scalar, sequence, map };
    struct Entry;

    Kind kind = Kind::null;
    std::string scalar;          // text of a scalar, unquoted
    bool quoted = false;         // the scalar stood in quotes: it is a text even if it looks like a number
    bool blank = false;          // null because nothing was written, as behind "nb:"; not by the word null, or ~.
                                 // The scalar may say what was written instead.
    std::vector<Entry> entries;  // of a map, in the order of the file
    std::vector<Node> items;     // of a sequence
    std::string source;          // file name, or "--set"
    int line = 0;                // from 1; 0: no line (--set)

    /// The value under `key` of a map, or nullptr.
    Node const* find(std::string_view key) const;
    Node* find(std::string_view key);

    /// "conf/simple.yaml:14" or "--set".
    std::string where() const;
};

/// One key of a map and its value.
struct Node::Entry {
    std::string key;
    Node value;

    Entry(std::string entry_key, Node entry_value) : key(std::move(entry_key)), value(std::move(entry_value)) {}
};

/// Reads a YAML file. Throws ConfigError ("file:line: ...") for a missing or unreadable file, a syntax error, a
/// document that is not a map, nesting deeper than 100, or more than a million nodes once aliases are followed. A key
/// that stands twice in one map is a warning, the last one wins; in `objects` each is kept: the value becomes a list.
/// `<<` merges maps as in YAML 1.1. `content` is what an empty file is told to hold.
Node read_yaml_file(std::string const& path,
                    std::string_view content = "expected a map of keys, in a configuration with at least 'objects'");

/// The first document of `text`; a null node when there is none. `source` is the file name for messages. Errors as in
/// read_yaml_file.
Node parse_yaml(std::string const& text, std::string const& source);

/// Applies one `--set a.b.c=value`: the value is YAML; maps on the way are made where they are missing, a number walks
/// into a sequence, `\.` is a dot inside a key. Throws ConfigError when the text has no '=' or a path runs through a
/// scalar.
void apply_override(Node& root, std::string const& assignment);

/// The tree a single run sees: `default_option` in place of batch options and optimisation domains (null where there is
/// none), hierarchical alternatives replaced by their `default`. See docs/configuration.md, "How a file is read".
/// A map of options that has another key is one of the `problems`.
Node resolve_options(Node const& node, Problems& problems);

/// YAML text of the tree; reading it again gives the same tree.
std::string to_yaml(Node const& root);

/// The node at a dotted path below `root` ("p.k", "list.0", `a\.b`; an exact dotted key wins), or nullptr.
Node const* find_path(Node const& root, std::string_view dotted_path);

// Dotted paths into a tree: "objects.robots.nb", "parameters.list.0", `a\.b` for a key that holds a dot.

struct SplitPath {
    std::string first;      // the first key, `\.` turned into a dot
    std::string_view rest;  // behind the dot that follows it
    bool last = true;       // no dot follows: `first` is the whole path
};

SplitPath split_path(std::string_view dotted_path);

/// The entry of a map under `key`, or the item of a sequence at that index; nullptr when there is none.
Node const* child_at(Node const& parent, std::string_view key);
Node* child_at(Node& parent, std::string_view key);

// How large a configuration may be. Aliases are copied, so that a few lines could ask for more than any memory.

inline constexpr std::size_t kMaxDepth = 100;
inline constexpr std::size_t kMaxNodes = 1'000'000;

struct TreeSize {
    std::size_t nodes = 0;
    std::size_t depth = 0;  // 1: a node without children
};

inline TreeSize size_of(Node const& node) {
    TreeSize size{1, 0};
    auto const add = [&size](Node const& child) {
        TreeSize const below = size_of(child);
        size.nodes += below.nodes;
        size.depth = std::max(size.depth, below.depth);
    };
    for (auto const& [key, value] : node.entries) {
        add(value);
    }
    for (Node const& item : node.items) {
        add(item);
    }
    size.depth += 1;
    return size;
}

}  // namespace pogosim
