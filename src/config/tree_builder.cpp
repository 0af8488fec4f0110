#include "config/tree_builder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "base/error.hpp"
#include "base/log.hpp"
#include "config/option_keys.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

constexpr auto kTextTag = "tag:yaml.org,2002:str";
constexpr auto kQuotedTag = "!";
constexpr auto kMergeKey = "<<";

int line_of(YAML::Mark const& mark) {
    return mark.line + 1;
}

}  // namespace

void TreeBuilder::fail(int line, std::string const& what) const {
    throw ConfigError(fmt::format("{}:{}: {}", source_, line, what));
}

Node TreeBuilder::make(Node::Kind kind, YAML::Mark const& mark) const {
    Node node;
    node.kind = kind;
    node.source = source_;
    node.line = line_of(mark);
    return node;
}

void TreeBuilder::OnDocumentStart(YAML::Mark const& mark) {
    first_line_ = line_of(mark);
}

void TreeBuilder::OnNull(YAML::Mark const& mark, YAML::anchor_t anchor) {
    admit({1, 1}, line_of(mark));
    Node node = make(Node::Kind::null, mark);
    // Behind a key without a value, the mark is where the next key stands.
    std::string_view const written = text_.substr(std::min(text_.size(), static_cast<std::size_t>(mark.pos)), 4);
    node.blank = !written.starts_with('~') && lower_case(std::string(written)) != "null";
    add(std::move(node), anchor);
}

void TreeBuilder::OnScalar(YAML::Mark const& mark, std::string const& tag, YAML::anchor_t anchor,
                           std::string const& value) {
    if (value.find('\0') != std::string::npos) {
        fail(line_of(mark), "a string contains a zero byte (\\0), and no text of a configuration can");
    }
    if (value.find(kEndMark.substr(0, kEndMark.size() - 1)) != std::string::npos) {
        fail(line_of(mark), "not valid YAML: the string that starts here does not end; is its closing quote missing?");
    }
    admit({1, 1}, line_of(mark));
    Node node = make(Node::Kind::scalar, mark);
    node.scalar = value;
    node.quoted = tag == kQuotedTag || tag == kTextTag;
    add(std::move(node), anchor);
}

void TreeBuilder::OnAlias(YAML::Mark const& mark, YAML::anchor_t anchor) {
    auto const known = anchors_.find(anchor);
    if (known == anchors_.end()) {
        fail(line_of(mark), "this alias (*name) is inside the value it refers to");
    }
    admit(size_of(known->second), line_of(mark));
    Node copy = known->second;
    copy.line = line_of(mark);
    add(std::move(copy), 0);
}

void TreeBuilder::OnSequenceStart(YAML::Mark const& mark, std::string const& /*tag*/, YAML::anchor_t anchor,
                                  YAML::EmitterStyle::value /*style*/) {
    open(make(Node::Kind::sequence, mark), anchor);
}

void TreeBuilder::OnMapStart(YAML::Mark const& mark, std::string const& /*tag*/, YAML::anchor_t anchor,
                             YAML::EmitterStyle::value /*style*/) {
    open(make(Node::Kind::map, mark), anchor);
}

/// Merged entries come first, and the map's own entries replace those of the same key.
void TreeBuilder::OnMapEnd() {
    Open& map = open_.back();
    for (auto const& [place, lines] : map.again) {
        auto const& [category, entries] = map.node.entries[place];
        log().warn(
            "{}: objects.{} appears on lines {}; all of them are used, in the category '{}'. To avoid this warning, "
            "put them in a list under one key",
            entries.where(), category, fmt::join(lines, ", "), category);
    }
    if (!map.merged.empty()) {
        std::vector<Node::Entry> const own = std::exchange(map.node.entries, {});
        map.index.clear();
        for (Node const& merged : map.merged) {
            for (auto const& entry : merged.entries) {
                if (map.index.try_emplace(entry.key, map.node.entries.size()).second) {
                    map.node.entries.push_back(entry);
                }
            }
        }
        for (auto const& entry : own) {
            auto const [place, is_new] = map.index.try_emplace(entry.key, map.node.entries.size());
            if (is_new) {
                map.node.entries.push_back(entry);
            } else {
                map.node.entries[place->second] = entry;
            }
        }
    }
    close();
}

void TreeBuilder::open(Node node, YAML::anchor_t anchor) {
    admit({1, 1}, node.line);
    Open opened;
    opened.node = std::move(node);
    opened.anchor = anchor;
    open_.push_back(std::move(opened));
}

void TreeBuilder::close() {
    Open closed = std::move(open_.back());
    open_.pop_back();
    add(std::move(closed.node), closed.anchor);
}

void TreeBuilder::add(Node node, YAML::anchor_t anchor) {
    if (anchor != 0) {
        admit({size_of(node).nodes, 0}, node.line);  // the copy kept for aliases takes memory too
        anchors_[anchor] = node;
    }
    if (open_.empty()) {
        root_ = std::move(node);
        return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == Node::Kind::sequence) {
        parent.node.items.push_back(std::move(node));
    } else if (parent.has_key) {
        take_value(parent, std::move(node));
    } else {
        take_key(parent, node);
    }
}

void TreeBuilder::take_key(Open& map, Node const& key) const {
    if (key.kind != Node::Kind::scalar) {
        fail(key.line, "the key of a map must be a plain string");
    }
    map.has_key = true;
    map.key = key.scalar;
    map.key_is_merge = !key.quoted && key.scalar == kMergeKey;
    map.key_line = key.line;
}

void TreeBuilder::take_value(Open& map, Node value) const {
    map.has_key = false;
    if (map.key_is_merge) {
        collect_merged(map, std::move(value));
        return;
    }
    value.line = map.key_line;
    auto const [place, is_new] = map.index.try_emplace(map.key, map.node.entries.size());
    if (is_new) {
        map.node.entries.emplace_back(map.key, std::move(value));
        return;
    }
    take_again(map, map.node.entries[place->second], std::move(value));
}

/// Categories of one name are as many entries; any other key has its last value.
void TreeBuilder::take_again(Open& map, Node::Entry& earlier, Node value) const {
    if (!is_in_objects() || is_option_key(map.key)) {
        log().warn("{}: duplicate key '{}', first on line {}; the last one is used", value.where(), map.key,
                   earlier.value.line);
        earlier.value = std::move(value);
        return;
    }
    std::vector<int>& lines = map.again[map.index[map.key]];
    if (lines.empty()) {
        lines.push_back(earlier.value.line);
    }
    lines.push_back(value.line);
    if (earlier.value.kind != Node::Kind::sequence) {
        Node list;
        list.kind = Node::Kind::sequence;
        list.source = earlier.value.source;
        list.line = earlier.value.line;
        list.items.push_back(std::move(earlier.value));
        earlier.value = std::move(list);
    }
    if (value.kind == Node::Kind::sequence) {
        std::ranges::move(value.items, std::back_inserter(earlier.value.items));
    } else {
        earlier.value.items.push_back(std::move(value));
    }
}

/// True when the innermost open map is `objects`, or what an alternative of a batch lays over it.
bool TreeBuilder::is_in_objects() const {
    std::vector<std::string_view> path;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
        if (open_[i].key == kHierarchicalOptions) {
            ++i;  // the name of the alternative
        } else {
            path.emplace_back(open_[i].key);
        }
    }
    return path.size() == 1 && path.front() == "objects";
}

void TreeBuilder::collect_merged(Open& map, Node value) const {
    std::vector<Node> maps;
    if (value.kind == Node::Kind::sequence) {
        maps = std::move(value.items);
    } else {
        maps.push_back(std::move(value));
    }
    for (Node& merged : maps) {
        if (merged.kind != Node::Kind::map) {
            fail(map.key_line, "the merge key '<<' takes a map or a list of maps");
        }
        map.merged.push_back(std::move(merged));
    }
}

void TreeBuilder::admit(TreeSize const& size, int line) {
    if (open_.size() + size.depth > kMaxDepth) {
        fail(line, fmt::format("nested deeper than {} levels once aliases are followed", kMaxDepth));
    }
    node_count_ += size.nodes;
    if (node_count_ > kMaxNodes) {
        fail(line, fmt::format("more than {} values once aliases are followed", kMaxNodes));
    }
}

}  // namespace pogosim
