// Turns what the YAML parser reports, event by event, into a tree of nodes with their lines.
#pragma once

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/mark.h>

#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "config/tree.hpp"

namespace pogosim {

/// A sentinel that is appended to a text before it is parsed. In a valid text it is a comment. A quote that is never
/// closed, which the parser accepts up to the end of the file, contains it and is detected. Its control characters
/// cannot occur in the text itself.
inline constexpr std::string_view kEndMark = "#\x01\x02\x03\n";

class TreeBuilder final : public YAML::EventHandler {
public:
    /// `text`: what is parsed; outlives this.
    TreeBuilder(std::string_view text, std::string source) : text_(text), source_(std::move(source)) {}

    /// The document; null before one was read.
    Node const& root() const { return root_; }
    int first_line() const { return first_line_; }

    void OnDocumentStart(YAML::Mark const& mark) override;
    void OnDocumentEnd() override {}
    void OnNull(YAML::Mark const& mark, YAML::anchor_t anchor) override;
    void OnAlias(YAML::Mark const& mark, YAML::anchor_t anchor) override;
    void OnScalar(YAML::Mark const& mark, std::string const& tag, YAML::anchor_t anchor,
                  std::string const& value) override;
    void OnSequenceStart(YAML::Mark const& mark, std::string const& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value style) override;
    void OnSequenceEnd() override { close(); }
    void OnMapStart(YAML::Mark const& mark, std::string const& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value style) override;
    void OnMapEnd() override;

private:
    /// A map or sequence whose end has not been read yet.
    struct Open {
        Node node;
        YAML::anchor_t anchor = 0;
        bool has_key = false;  // a map waits for the value of `key`
        std::string key;
        bool key_is_merge = false;
        int key_line = 0;
        std::vector<Node> merged;                                 // values of `<<`
        std::unordered_map<std::string, std::size_t> index = {};  // key -> place in node.entries
        std::map<std::size_t, std::vector<int>> again = {};  // place in node.entries -> lines of a repeated category
    };

    Node make(Node::Kind kind, YAML::Mark const& mark) const;
    void open(Node node, YAML::anchor_t anchor);
    void close();
    void add(Node node, YAML::anchor_t anchor);
    void take_key(Open& map, Node const& key) const;
    void take_value(Open& map, Node value) const;
    void take_again(Open& map, Node::Entry& earlier, Node value) const;
    bool is_in_objects() const;
    void collect_merged(Open& map, Node value) const;
    void admit(TreeSize const& size, int line);
    [[noreturn]] void fail(int line, std::string const& what) const;

    std::string_view text_;
    std::string source_;
    Node root_;
    int first_line_ = 0;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, Node> anchors_;
    std::size_t node_count_ = 0;
};

}  // namespace pogosim
