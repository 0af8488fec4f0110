// Which of the values under `parameters` a program has asked for, and which names it asked for that are not there.
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "config/tree.hpp"

namespace pogosim {

class ParameterUse {
public:
    /// `parameters` outlives this.
    explicit ParameterUse(Node const& parameters) : parameters_(parameters) {}

    /// The program asks for a name, a dotted path as in find_path. Returns the value there the first time; nullptr
    /// later, and where there is none.
    Node const* ask(std::string const& name);

    /// The values that nobody has asked for: "walk.sped (conf/a.yaml:14; did you mean 'walk.speed'?), ...". Empty when
    /// there are none. Of a map, each value counts; a list, of which one item was read, counts as read.
    std::string unread() const;

private:
    bool was_read(Node const& node) const { return read_.contains(&node); }
    bool any_part_was_read(Node const& node) const;
    void collect(Node const& node, std::string const& path, std::vector<std::string>& unread) const;

    Node const& parameters_;
    std::unordered_set<Node const*> read_;
    std::vector<std::string> missed_;
};

}  // namespace pogosim
