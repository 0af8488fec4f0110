#include "config/option_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/nearest_name.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

constexpr double kMostOptions = 1000000;

using Words = std::span<std::string_view const>;

/// The origin of a map's keys.
enum class Names {
    top_level,   // the simulator, and batch tools add the names of alternatives
    ours,        // the simulator
    categories,  // the user; below them, the simulator
    parameters,  // the user, and below them, too
};

std::string child(std::string const& path, std::string_view key) {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

bool is_in(Words words, std::string_view key) {
    return std::ranges::find(words, key) != words.end();
}

std::string advice(std::string_view key, Words words) {
    std::vector<std::string> const names(words.begin(), words.end());
    std::string const nearest = did_you_mean(shown(key), names);
    return nearest.empty() ? fmt::format("; known are {}", fmt::join(names, ", ")) : nearest;
}

/// `beside`: a word that tells what map it is; may be empty.
void refuse_others(Node const& map, std::string const& path, Words words, std::string_view beside) {
    for (auto const& [key, value] : map.entries) {
        if (!is_in(words, key)) {
            fail_at({value, path},
                    fmt::format("unknown key '{}'{}{}", shown(key),
                                beside.empty() ? "" : fmt::format(" beside '{}'", beside), advice(key, words)));
        }
    }
}

/// Messages are those of pogobatch (batch/options.py).
[[noreturn]] void refuse(Node const& value, std::string const& path, std::string_view key, std::string const& message) {
    fail_at({value, path}, fmt::format("{}: {}", key, message));
}

/// A text so that several in a row are told apart.
std::string with_length(std::string const& text) {
    return fmt::format("{} {}", text.size(), text);
}

/// What a value is to the simulator; two values that share one of these are the same: 3, 3.0 and '3', true and 'true'.
std::vector<std::string> identities(Node const& value) {
    std::string all;
    switch (value.kind) {
        case Node::Kind::null:
            return {"null"};
        case Node::Kind::sequence:
            for (Node const& item : value.items) {
                all += with_length(identities(item).front());
            }
            return {"list " + all};
        case Node::Kind::map:
            for (auto const& [key, inner] : value.entries) {
                all += with_length(key) + with_length(identities(inner).front());
            }
            return {"map " + all};
        case Node::Kind::scalar:
            break;
    }
    std::string const text = "text " + value.scalar;
    std::string const word = lower_case(value.scalar);
    if (value.quoted) {
        return {text};
    }
    if (std::optional<double> const number = number_of(value)) {
        return {fmt::format("number {}", *number + 0.0), text};  // -0 is 0
    }
    if (word == "true" || word == "false") {
        return {word, text, "text " + word};
    }
    return {text};
}

/// `path`: of the list.
void refuse_twice(Node const& list, std::string const& path) {
    std::map<std::string, Node const*> first;
    for (Node const& item : list.items) {
        for (std::string const& identity : identities(item)) {
            auto const [before, is_new] = first.emplace(identity, &item);
            if (!is_new && before->second != &item) {
                std::string const was = found_text(*before->second);
                std::string const is = found_text(item);
                fail_at({item, path},
                        fmt::format("expected different values, found {}; their runs would be the same: remove one",
                                    was == is ? is + " twice" : fmt::format("{} and {}, which are the same", was, is)));
            }
        }
    }
}

void check_list(Node const& options, std::string const& path) {
    if (options.kind != Node::Kind::sequence) {
        bool const is_value = options.kind == Node::Kind::scalar;
        refuse(options, path, kBatchOptions,
               fmt::format("expected a list of values, found {}{}", found_text(options),
                           is_value ? fmt::format("; write [{}]", shown(options.scalar)) : ""));
    }
    if (options.items.empty()) {
        refuse(options, path, kBatchOptions, "expected at least one value, found an empty list");
    }
}

double number_of_range(Node const& range, std::string const& path, std::string_view key) {
    Node const* const node = range.find(key);
    if (node == nullptr) {
        refuse(range, path, kBatchRange, fmt::format("'{}' is missing; expected start, stop and step", key));
    }
    std::optional<double> const number = number_of(*node);
    if (!number || !(std::abs(*number) < 1e300)) {
        refuse(*node, path, kBatchRange, fmt::format("{}: expected a number, found {}", key, found_text(*node)));
    }
    return *number;
}

bool is_inclusive(Node const& range, std::string const& path) {
    Node const* const node = range.find("inclusive");
    if (node == nullptr) {
        return false;
    }
    std::optional<bool> const truth = truth_of(*node);
    if (!truth) {
        refuse(*node, path, kBatchRange, fmt::format("inclusive: expected true or false, found {}", found_text(*node)));
    }
    return *truth;
}

/// pogobatch counts in decimals; one value more or less of rounding makes no difference here.
void check_range(Node const& range, std::string const& path) {
    if (range.kind != Node::Kind::map) {
        refuse(range, path, kBatchRange,
               fmt::format("expected a map, such as {{start: 0, stop: 10, step: 1}}, found {}", found_text(range)));
    }
    refuse_others(range, child(path, kBatchRange), kRangeKeys, {});
    double const start = number_of_range(range, path, "start");
    double const stop = number_of_range(range, path, "stop");
    double const step = number_of_range(range, path, "step");
    if (step == 0.0) {
        refuse(range, path, kBatchRange, "step is 0; give a step from start towards stop");
    }
    double const steps = (stop - start) / step;
    if (is_inclusive(range, path) ? steps < 0.0 : steps <= 0.0) {
        refuse(range, path, kBatchRange,
               fmt::format("there is no value from {} to {} in steps of {}; give another stop, a step of the other "
                           "sign, or inclusive: true",
                           range.find("start")->scalar, range.find("stop")->scalar, range.find("step")->scalar));
    }
    if (steps > 1.0 && (start + step == start || stop - step == stop)) {
        refuse(range, path, kBatchRange,
               fmt::format("a step of {} is too small to tell values apart; give a larger one",
                           range.find("step")->scalar));
    }
    if (steps > kMostOptions) {
        refuse(range, path, kBatchRange,
               fmt::format("there are more than {} values; give a larger step", kMostOptions));
    }
    Node const* const type = range.find("type");
    if (type != nullptr && type->scalar != "int" && type->scalar != "float") {
        refuse(*type, path, kBatchRange, fmt::format("type: expected int or float, found {}", found_text(*type)));
    }
    if (type != nullptr && type->scalar == "int" && (std::trunc(start) != start || std::trunc(step) != step)) {
        refuse(*type, path, kBatchRange,
               fmt::format("type is int, but start {} or step {} is not a whole number", range.find("start")->scalar,
                           range.find("step")->scalar));
    }
}

class OptionsCheck {
public:
    OptionsCheck(Node const& root, Problems& problems) : names_of_batches_(batch_names(root)), problems_(problems) {}

    /// Collects what is wrong with a node; a mistake in its own words ends the look at it.
    void look_at(Node const& node, std::string const& path, Names names) const {
        problems_.collect([&] { look_into(node, path, names); });
    }

private:
    void look_into(Node const& node, std::string const& path, Names names) const {
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            look_at(node.items[i], child(path, std::to_string(i)), below(names));
        }
        if (offers_options(node)) {
            look_at_options(node, path, names);
        } else {
            look_at_entries(node, path, names);
        }
        if (Node const* const alternatives = node.find(kHierarchicalOptions)) {
            look_at_alternatives(*alternatives, child(path, kHierarchicalOptions), names);
        }
    }

    static Names below(Names names) { return names == Names::parameters ? names : Names::ours; }

    static Names names_in(std::string_view key, Names names) {
        if (names != Names::top_level) {
            return below(names);
        }
        return key == "objects" ? Names::categories : key == "parameters" ? Names::parameters : Names::ours;
    }

    void look_at_options(Node const& options, std::string const& path, Names names) const {
        refuse_other_keys(options, path);
        check_values(options, path);
        for (auto const& [key, value] : options.entries) {
            std::string const inner = child(path, key);
            if (key == kOptimizationDomain) {
                look_at_domain(value, inner, names);
            } else if (key == kBatchOptions) {
                look_at_each(value, inner, names);
            } else if (key == kDefaultOption) {
                look_at(value, inner, names);
            }
        }
    }

    static void check_values(Node const& options, std::string const& path) {
        Node const* const list = options.find(kBatchOptions);
        Node const* const range = options.find(kBatchRange);
        if (list != nullptr && range != nullptr) {
            fail_at({options, path},
                    fmt::format("expected either {} or {}, found both; remove one", kBatchOptions, kBatchRange));
        }
        if (list != nullptr) {
            check_list(*list, path);
            refuse_twice(*list, child(path, kBatchOptions));
        }
        if (range != nullptr) {
            check_range(*range, path);
        }
    }

    void look_at_domain(Node const& domain, std::string const& path, Names names) const {
        refuse_others(domain, path, kDomainKeys, {});
        if (Node const* const choices = domain.find("choices")) {
            refuse_twice(*choices, child(path, "choices"));
            look_at_each(*choices, child(path, "choices"), names);
        }
        if (Node const* const init = domain.find("init")) {
            look_at(*init, child(path, "init"), names);
        }
    }

    /// Items have the path of their list.
    void look_at_each(Node const& list, std::string const& path, Names names) const {
        for (std::size_t i = 0; i < list.items.size(); ++i) {
            look_at(list.items[i], child(path, std::to_string(i)), names);
        }
    }

    void look_at_entries(Node const& map, std::string const& path, Names names) const {
        bool is_told = false;  // one slip of a map is enough
        for (auto const& entry : map.entries) {
            auto const& [key, value] = entry;
            bool const has_options = names != Names::top_level || !is_in(kWithoutOptions, key);
            if (key == kHierarchicalOptions || !has_options) {
                continue;
            }
            std::string_view const word = misspelt_option(key);
            if (!word.empty() && !may_be_a_name(entry, word, map, names)) {
                if (std::exchange(is_told, true)) {
                    continue;
                }
                problems_.collect([&, &key = key, &value = value] {
                    fail_at({value, path.empty() ? "the top level" : path},
                            fmt::format("unknown key '{}'; did you mean '{}'?", shown(key), word));
                });
                continue;
            }
            look_at(value, child(path, key), names_in(key, names));
        }
    }

    /// Whether a key that resembles a word of options may be a name that the user has chosen.
    bool may_be_a_name(Node::Entry const& entry, std::string_view word, Node const& map, Names names) const {
        bool const is_map = entry.value.kind == Node::Kind::map;
        switch (names) {
            case Names::top_level:  // single values may be the names of alternatives
                return entry.value.kind == Node::Kind::scalar || is_name_of_batches(entry.key);
            case Names::categories:
                return word != kHierarchicalOptions;
            case Names::parameters:
                return word == kHierarchicalOptions ? !is_map : !is_meant_as_options(map);
            case Names::ours:
                break;
        }
        return false;
    }

    /// Whether all keys are misspelt words of options, and one of them has a value that fits its word.
    static bool is_meant_as_options(Node const& map) {
        auto const is_slip = [](Node::Entry const& entry) { return !misspelt_option(entry.key).empty(); };
        auto const fits = [](Node::Entry const& entry) {
            std::string_view const word = misspelt_option(entry.key);
            Node::Kind const kind = entry.value.kind;
            return word == kBatchOptions ? kind == Node::Kind::sequence
                                         : word != kDefaultOption && kind == Node::Kind::map;
        };
        return std::ranges::all_of(map.entries, is_slip) && std::ranges::any_of(map.entries, fits);
    }

    bool is_name_of_batches(std::string const& key) const {
        return std::ranges::find(names_of_batches_, key) != names_of_batches_.end();
    }

    void look_at_alternatives(Node const& alternatives, std::string const& path, Names names) const {
        bool const has_default = alternatives.find(kDefaultAlternative) != nullptr;
        for (auto const& [key, value] : alternatives.entries) {
            if (key == kAlternativesName) {
                continue;
            }
            bool const is_alternative = value.kind == Node::Kind::map || value.kind == Node::Kind::null;
            if (!is_alternative && key != kDefaultAlternative) {
                bool const is_name = is_slip_of(kAlternativesName, key);
                fail_at({value, child(path, key)},
                        fmt::format("expected a map of keys and values, found {}{}", found_text(value),
                                    is_name ? fmt::format("; did you mean '{}'?", kAlternativesName) : ""));
            }
            if (!has_default && is_slip_of(kDefaultAlternative, key)) {
                fail_at({value, path},
                        fmt::format("there is no '{0}', which a single run takes; did you mean '{0}', not '{1}'?",
                                    kDefaultAlternative, shown(key)));
            }
            look_at(value, child(path, key), names);
        }
    }

    std::vector<std::string> names_of_batches_;
    Problems& problems_;
};

}  // namespace

void refuse_other_keys(Node const& options, std::string const& path) {
    auto const beside =
        std::ranges::find_if(options.entries, [](Node::Entry const& entry) { return is_in(kValueOptions, entry.key); });
    Node words = options;
    std::erase_if(words.entries, [](Node::Entry const& entry) { return entry.key == kHierarchicalOptions; });
    refuse_others(words, path, kValueOptions, beside->key);
}

void check_options(Node const& root, Problems& problems) {
    OptionsCheck(root, problems).look_at(root, "", Names::top_level);
}

}  // namespace pogosim
