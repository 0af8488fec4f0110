// The tables behind a configuration. Every struct that a file can fill has one table: a line per YAML key with the
// member it goes to, the numbers it takes, its unit and what it means. The loader reads by these tables, messages and
// the list of known names come from them, and so does the configuration reference. Defaults are those of a
// default-constructed struct.
//
//     {"body_density", &BodySpec::density, above(0).up_to(1e15), "per (100 mm)^2", "Mass per area."},
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "config/range.hpp"
#include "config/values.hpp"

namespace pogosim {

/// How strictly a choice takes its names.
struct ChoiceRule {
    bool any_case = false;    // "Disk" is "disk"; the names of the table are in lower case
    bool warns_only = false;  // an unknown name is a warning and the default is used, else an error
};

/// A member that takes one of several names.
template <class T>
struct Choice {
    std::vector<std::string> names;
    std::function<void(T&, std::size_t)> set;      // by index into names
    std::function<std::string(T const&)> current;  // the name of the member's value; empty: none
    ChoiceRule rule;
};

template <class E>
using NamedValues = std::vector<std::pair<std::string, E>>;

template <class T, class E>
Choice<T> one_of(E T::*member, NamedValues<E> const& named, ChoiceRule const& rule = {}) {
    Choice<T> choice;
    choice.rule = rule;
    for (auto const& [name, value] : named) {
        choice.names.push_back(name);
    }
    choice.set = [member, named](T& into, std::size_t index) { into.*member = named[index].second; };
    choice.current = [member, named](T const& from) {
        auto const at = std::ranges::find(named, from.*member, &std::pair<std::string, E>::second);
        return at == named.end() ? std::string() : at->first;
    };
    return choice;
}

/// A member that takes a number, or a word in place of one.
template <class T, class Number = double>
struct NumberOr {
    std::optional<Number> T::*member;  // empty: the word stands there
    std::string_view word;
};

/// A key that a separate function reads (such as a map of further keys), or that only the tools read.
struct Elsewhere {
    std::string_view expected;  // "a map of categories"
};

template <class T>
using Field = std::variant<bool T::*, int T::*, std::int64_t T::*, float T::*, double T::*, std::string T::*, Vec2 T::*,
                           IntRange T::*, std::optional<float> T::*, std::optional<std::uint32_t> T::*,
                           std::optional<std::array<float, 3>> T::*, std::optional<std::vector<std::string>> T::*,
                           Interval T::*, std::optional<Interval> T::*, Axes T::*, std::optional<double> T::*,
                           std::optional<std::uint64_t> T::*, Choice<T>, NumberOr<T>, NumberOr<T, int>, Elsewhere>;

/// One line of a table.
template <class T>
struct Key {
    std::string_view name;
    Field<T> field;
    Range range;
    std::string_view unit;
    std::string_view doc;
    bool required = false;
    bool (*is_used)(T const&) = nullptr;  // absent: always; asked when the keys above it in the table have been read
    std::string_view same_as{};           // the key that this is an alias of; only one of them may be set
    bool warns_of_blank = true;           // where it has no value, a warning says that the default is used

    bool has_effect(T const& values) const { return is_used == nullptr || is_used(values); }

    /// The same key, with an effect only where the condition holds for the struct. Elsewhere any value of its type is
    /// accepted and ignored.
    Key only_if(bool (*condition)(T const&)) const {
        Key key = *this;
        key.is_used = condition;
        return key;
    }

    /// The same key of a switch, which the values in use (`resolved_configuration`) name only where it is not at its
    /// default. For switches that came after the files of many runs: what does not use them says what it said before.
    template <bool T::*kSwitch, bool kDefault>
    Key left_out_at_default() const {
        return only_if([](T const& values) { return values.*kSwitch != kDefault; });
    }

    /// The same key, whose value check_scenario() asks for.
    Key needing_a_name() const {
        Key key = *this;
        key.warns_of_blank = false;
        return key;
    }

    /// The same key of a section, which may have nothing in it.
    Key may_be_empty() const {
        Key key = *this;
        key.warns_of_blank = false;
        return key;
    }

    /// The same key, as an alias of the one with this name.
    Key other_name_of(std::string_view name_of_the_member) const {
        Key key = *this;
        key.same_as = name_of_the_member;
        return key;
    }
};

/// A line of a table without its struct: for messages and for the configuration reference.
struct KeyDescription {
    std::string name;
    std::string expected;      // "a number above 0 (mm)"
    std::string default_text;  // as YAML; empty: none
    std::string unit;
    std::string doc;
    bool required = false;
    bool warns_of_blank = true;
};

/// One function object out of several, for std::visit.
template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

/// "solid or periodic", "one of a, b, c".
std::string names_text(std::vector<std::string> const& names);

template <class T>
KeyDescription describe(Key<T> const& key, T const& defaults) {
    KeyDescription description;
    description.name = key.name;
    description.unit = key.unit;
    description.doc = key.doc;
    description.required = key.required;
    description.warns_of_blank = key.warns_of_blank;
    std::visit(Overloaded{
                   [&](Choice<T> const& choice) {
                       description.expected = names_text(choice.names);
                       description.default_text = key.required ? "" : choice.current(defaults);
                   },
                   [&]<class Number>(NumberOr<T, Number> const& field) {
                       description.expected = expected_text(Limits{key.range, key.unit}, Number{}) + ", or '" +
                                              std::string(field.word) + "'";
                       auto const& number = defaults.*field.member;
                       description.default_text = number ? value_text(*number) : std::string(field.word);
                   },
                   [&](Elsewhere const& elsewhere) { description.expected = elsewhere.expected; },
                   [&](auto T::*member) {
                       description.expected = expected_text(Limits{key.range, key.unit}, defaults.*member);
                       description.default_text = value_text(defaults.*member);
                   },
               },
               key.field);
    return description;
}

/// The same of all keys of a table.
template <class T>
std::vector<KeyDescription> described(std::span<Key<T> const> keys, T const& defaults = {}) {
    std::vector<KeyDescription> descriptions;
    std::ranges::transform(keys, std::back_inserter(descriptions),
                           [&](Key<T> const& key) { return describe(key, defaults); });
    return descriptions;
}

}  // namespace pogosim
