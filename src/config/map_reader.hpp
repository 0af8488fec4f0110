// Reads one map of a configuration with tables of keys. Several tables may be applied to one map; a key in none of them
// is an unknown key.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.hpp"
#include "config/key.hpp"
#include "config/reading.hpp"
#include "config/tree.hpp"
#include "config/values.hpp"

namespace pogosim {

/// What MapReader::read_map() expects.
inline constexpr std::string_view kMapOfKeysBelow = "a map";

class MapReader {
public:
    /// `path` is the key path of the map, empty at the top level. A null node is an empty map; throws ConfigError for
    /// anything else that is not a map. Mistakes in keys are collected in `reading`, which outlives this.
    MapReader(Node const& map, std::string path, Reading& reading);

    /// Fills `into` from the keys of the table. A key that is absent or null leaves its member as it is; so does a
    /// value out of range whose key has no effect in the chosen mode.
    template <class T>
    void read(std::span<Key<T> const> keys, T& into);

    /// Reads a table whose keys have no effect here: only the types of their values have to be right.
    template <class T>
    void read_unused(std::span<Key<T> const> keys, T& into);

    /// Reads the map under a key with `read`, which gets a reader of it and takes tables; a key that is absent or null
    /// is an empty map. Its keys are known as "key.inner".
    template <class Read>
    void read_map(std::string_view key, Read const& read);

    /// Reads the map under a key that is a part of its own: its keys are not known here. Where there is none, `read`
    /// gets an empty one, and the key stays absent. Anything else is a mistake, which says what was `expected`.
    template <class Read>
    void read_map(std::string_view key, std::string_view expected, Read const& read);

    /// The value under a key, or nullptr when it is absent or null.
    Node const* find(std::string_view key) const;

    /// The one of two keys, to be given together, that stands alone.
    struct LoneKey {
        std::string_view given;
        std::string_view missing;
    };
    /// Returns nothing when both are given, or neither.
    std::optional<LoneKey> lone_key(std::string_view one, std::string_view other) const;

    /// The key path of a key of this map.
    std::string path_of(std::string_view key) const;

    Place place() const { return {map_, path_}; }
    Reading& reading() const { return reading_; }

    /// Does a part of the reading; a mistake that ends it is collected, and the rest goes on. True if there was none.
    template <class Part>
    bool collect(Part const& part) const {
        return reading_.problems.collect(part);
    }

    /// Collects a mistake in the value of a key that is present, unless it is known to be wrong already.
    void refuse(std::string_view key, std::string const& what) const;

    /// All keys of all tables read so far, with the defaults that stood in the structs before.
    std::vector<KeyDescription> const& known_keys() const { return known_; }

    /// The keys that have an effect, with their values, defaults included; reading this map again gives the same
    /// values. A key that is read elsewhere has the node that was written, unless set_value() replaced it.
    Node const& values() const { return values_; }

    /// The value of a key that is read elsewhere.
    void set_value(std::string_view key, Node value);

    /// The values of a table whose keys the chosen mode sets, whatever is written.
    template <class T>
    void note_values(std::span<Key<T> const> keys, T const& from);

    /// A required key that is missing is a mistake. finish() calls it.
    void refuse_missing_keys() const;

    /// Call last: a required key that is missing is a mistake; an unknown key that is not among the ignored ones is a
    /// warning, or a mistake if the reading is strict.
    void finish(std::vector<std::string> const& ignored = {}) const;

private:
    /// Index of the name that stands at `place`; nothing, with a warning, where the default is used instead.
    std::optional<std::size_t> pick(Place const& place, std::vector<std::string> const& names, ChoiceRule const& rule,
                                    std::string const& default_name) const;
    /// The number at `place`, or nothing where the word stands.
    static std::optional<double> number_or_word(Place const& place, Limits const& limits, std::string_view word,
                                                std::string_view expected);

    template <class T>
    void read_one(Key<T> const& key, bool is_used, T& into);
    template <class T>
    void read_node(Key<T> const& key, Node const& node, bool is_used, T& into);
    void look_for_slips(Place const& place, Limits const& limits, bool is_integer) const;

    template <class T>
    Node value_of(Key<T> const& key, T const& from) const;

    void add_map(std::string_view key, MapReader const& inner);
    void refuse_both_names(std::string_view name, std::string_view other_name) const;
    void report_unknown(std::string const& key, Node const& value) const;
    void report_blank(KeyDescription const& key, Node const& value) const;

    Node const& map_;
    std::string path_;
    Reading& reading_;
    std::vector<KeyDescription> known_;
    Node values_;
};

template <class T>
void MapReader::read(std::span<Key<T> const> keys, T& into) {
    for (Key<T> const& key : keys) {
        collect([&] { refuse_both_names(key.name, key.same_as); });
        read_one(key, key.has_effect(into), into);
    }
    note_values(keys, into);
}

template <class Read>
void MapReader::read_map(std::string_view key, Read const& read) {
    static Node const empty;
    Node const* const map = find(key);
    MapReader inner(map == nullptr ? empty : *map, path_of(key), reading_);
    read(inner);
    inner.finish();
    add_map(key, inner);
}

template <class Read>
void MapReader::read_map(std::string_view key, std::string_view expected, Read const& read) {
    static Node const empty;
    Node const* const map = find(key);
    if (map != nullptr && map->kind != Node::Kind::map) {
        fail_expected({*map, path_of(key)}, expected);
    }
    MapReader inner(map == nullptr ? empty : *map, path_of(key), reading_);
    read(inner);
    if (map != nullptr) {
        inner.finish();
        set_value(key, inner.values());
    }
}

template <class T>
void MapReader::note_values(std::span<Key<T> const> keys, T const& from) {
    for (Key<T> const& key : keys) {
        if (key.same_as.empty() && key.has_effect(from)) {
            set_value(key.name, value_of(key, from));
        }
    }
}

template <class T>
void MapReader::read_unused(std::span<Key<T> const> keys, T& into) {
    for (Key<T> const& key : keys) {
        read_one(key, false, into);
    }
}

/// True when the value could be read if its key took every value of this type.
template <class Value>
bool is_of_type(Place const& place, Value scratch) {
    try {
        read_value(place, Limits{.range = any().or_infinity().or_nan()}, scratch);
    } catch (ConfigError const&) {
        return false;
    }
    return true;
}

template <class T>
void MapReader::read_one(Key<T> const& key, bool is_used, T& into) {
    known_.push_back(describe(key, into));
    if (Node const* const value = map_.find(key.name)) {
        collect([&] { read_node(key, *value, is_used, into); });
    }
}

template <class T>
void MapReader::read_node(Key<T> const& key, Node const& node, bool is_used, T& into) {
    Place const place{node, path_of(key.name)};
    Limits const limits{key.range, key.unit};
    std::visit(Overloaded{
                   [&](Choice<T> const& choice) {
                       if (auto const index = pick(place, choice.names, choice.rule, known_.back().default_text)) {
                           choice.set(into, *index);
                       }
                   },
                   [&]<class Number>(NumberOr<T, Number> const& field) {
                       if (node.kind != Node::Kind::null) {
                           auto const number = number_or_word(place, limits, field.word, known_.back().expected);
                           into.*field.member = number ? std::optional(static_cast<Number>(*number)) : std::nullopt;
                           look_for_slips(place, limits, kReadsIntegers<Number>);
                       }
                   },
                   [](Elsewhere const&) {},
                   [&](auto T::*member) {
                       if (node.kind == Node::Kind::null) {
                           return;
                       }
                       auto read = into.*member;
                       try {
                           read_value(place, limits, read);
                           into.*member = std::move(read);
                       } catch (ConfigError const&) {
                           if (is_used || reading_.thorough || !is_of_type(place, read)) {
                               throw;
                           }
                       }
                       if (is_used) {
                           look_for_slips(place, limits, kReadsIntegers<decltype(read)>);
                       }
                   },
               },
               key.field);
}

template <class T>
Node MapReader::value_of(Key<T> const& key, T const& from) const {
    return std::visit(Overloaded{
                          [&](Choice<T> const& choice) {
                              std::string const name = choice.current(from);
                              return name.empty() ? Node() : plain_node(name);
                          },
                          [&]<class Number>(NumberOr<T, Number> const& field) {
                              auto const& number = from.*field.member;
                              return number ? value_node(*number) : plain_node(std::string(field.word));
                          },
                          [&](Elsewhere const&) {
                              Node const* const written = find(key.name);
                              return written == nullptr ? Node() : *written;
                          },
                          [&](auto T::*member) { return value_node(from.*member); },
                      },
                      key.field);
}

}  // namespace pogosim
