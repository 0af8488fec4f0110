// Reads one map of a configuration by tables of keys. Several tables may be applied to one map; what none of them knows
// is an unknown key.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/key.hpp"
#include "config/tree.hpp"
#include "config/values.hpp"

namespace pogosim {

class MapReader {
public:
    /// `path` is the key path of the map, empty at the top level. A null node is an empty map; throws ConfigError for
    /// anything else that is no map.
    MapReader(Node const& map, std::string path, bool strict);

    /// Fills `into` from the keys of the table. A key that is absent or null leaves its member as it is.
    template <class T>
    void read(std::span<Key<T> const> keys, T& into);

    /// The value under a key, or nullptr when it is absent or null.
    Node const* find(std::string_view key) const;

    /// The key path of a key of this map.
    std::string path_of(std::string_view key) const;

    Place place() const { return {map_, path_}; }
    bool is_strict() const { return strict_; }

    /// All keys of all tables read so far, with the defaults that stood in the structs before.
    std::vector<KeyDescription> const& known_keys() const { return known_; }

    /// Call last: throws for a required key that is missing, warns for each unknown key (throws when strict).
    void finish() const;

private:
    /// Index of the name that stands at `place`; nothing, with a warning, where the default is used instead.
    static std::optional<std::size_t> pick(Place const& place, std::vector<std::string> const& names,
                                           ChoiceRule const& rule, std::string const& default_name);
    void refuse_missing_keys() const;
    void report_unknown(std::string const& key, Node const& value) const;

    Node const& map_;
    std::string path_;
    bool strict_;
    std::vector<KeyDescription> known_;
};

template <class T>
void MapReader::read(std::span<Key<T> const> keys, T& into) {
    for (Key<T> const& key : keys) {
        known_.push_back(describe(key, into));
        Node const* value = map_.find(key.name);
        if (value == nullptr) {
            continue;
        }
        Place const place{*value, path_of(key.name)};
        std::visit(Overloaded{
                       [&](Choice<T> const& choice) {
                           if (auto const index = pick(place, choice.names, choice.rule, known_.back().default_text)) {
                               choice.set(into, *index);
                           }
                       },
                       [](Elsewhere const&) {},
                       [&](auto T::*member) {
                           if (value->kind != Node::Kind::null) {
                               Limits const limits{key.range, key.unit};
                               read_value(place, limits, into.*member);
                               warn_of_slips(place, limits, kReadsIntegers<std::decay_t<decltype(into.*member)>>);
                           }
                       },
                   },
                   key.field);
    }
}

}  // namespace pogosim
