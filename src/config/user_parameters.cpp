#include "config/user_parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>

#include "base/counted.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "config/option_keys.hpp"
#include "config/source.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

constexpr Limits kAnyNumber{.range = any().or_infinity().or_nan()};

std::string path_of(std::string const& name) {
    return fmt::format("parameters.{}", name);
}

/// A value of another type than the program asks for.
class WrongTypeError : public KeyError {
public:
    explicit WrongTypeError(KeyError const& error) : KeyError(error) {}
};

[[noreturn]] void fail_type(Place const& place, std::string_view expected) {
    try {
        fail_expected(place, expected);
    } catch (KeyError const& error) {
        throw WrongTypeError(error);
    }
}

double read_number(Place const& place, double largest) {
    double value = 0.0;
    try {
        read_value(place, kAnyNumber, value);
    } catch (KeyError const& error) {
        throw WrongTypeError(error);
    }
    if (std::isfinite(value) && std::abs(value) > largest) {
        fail_expected(place, fmt::format("a number from {0} to {1}", number_text(-largest), number_text(largest)));
    }
    return value;
}

/// Numbers out of range are not of another type.
template <class T>
T read_of_type(Place const& place, Range const& range) {
    T value{};
    try {
        read_value(place, {.range = range}, value);
    } catch (KeyError const& error) {
        if (std::is_same_v<T, std::int64_t> && number_of(place.node)) {
            throw;
        }
        throw WrongTypeError(error);
    }
    return value;
}

/// Whether words stand in a name as they are: "traits" in "nb_traits".
bool has_words(std::string const& name, std::string const& words) {
    auto const apart = [](std::string text) {
        std::ranges::replace(text, '.', '_');
        return fmt::format("_{}_", text);
    };
    return apart(name).find(apart(words)) != std::string::npos;
}

bool has_misspelt_option(Node const& map) {
    return std::ranges::any_of(map.entries,
                               [](Node::Entry const& entry) { return !misspelt_option(entry.key).empty(); });
}

/// A value of which the program reads only the beginning.
void warn_of_rest(Place const& place, std::string_view what, std::size_t found, std::size_t most) {
    log().warn("{}: {}: the program has room for {}, found {}; the rest is ignored", place.node.where(),
               shown(place.path), counted(most, what), found);
}

}  // namespace

UserParameters::UserParameters(Scenario const& scenario, Conversions conversions) : conversions_(conversions) {
    if (Node const* const written = source_of(scenario).tree.find("parameters")) {
        parameters_ = *written;
    }
}

UserParameters UserParameters::with(std::string const& name, std::string const& yaml_value) const {
    Node changed = parameters_;
    apply_override(changed, fmt::format("{}={}", name, yaml_value));
    return UserParameters(std::move(changed));
}

Node const* UserParameters::ask(std::string const& name) {
    Node const* const node = find_path(parameters_, name);
    if (node != nullptr) {
        bool const is_first = read_.insert(node).second;
        if (is_first) {
            found_.push_back(name);
        }
        if (node->blank && is_first) {
            log().warn("{}: {}: {}; the program keeps its own", node->where(), shown(path_of(name)),
                       is_open_option(*node) ? node->scalar : "expected a value, found nothing");
        }
    } else if (std::ranges::find(missed_, name) == missed_.end()) {
        missed_.push_back(name);
    }
    return node == nullptr || node->kind == Node::Kind::null ? nullptr : node;
}

template <class T>
std::optional<T> UserParameters::converted(std::string const& name, std::function<T(Place const&)> const& convert) {
    Node const* const node = ask(name);
    if (node == nullptr) {
        return std::nullopt;
    }
    try {
        return convert({*node, path_of(name)});
    } catch (WrongTypeError const& error) {
        bool const may_be_for_others = node->source != kSetSource && !has_misspelt_option(*node);
        if (conversions_ == Conversions::lenient && may_be_for_others) {
            if (of_other_programs_.insert(node).second) {
                log().warn("{}; the program keeps its own value (--strict refuses this)", error.what());
            }
        } else if (problems_ != nullptr) {
            problems_->add(error.what());
        } else {
            throw;
        }
    } catch (KeyError const& error) {
        if (problems_ == nullptr) {
            throw;
        }
        problems_->add(error.what());
    }
    return std::nullopt;
}

template <class T>
std::optional<T> UserParameters::read(std::string const& name, Range const& range) {
    return converted<T>(name, [&](Place const& place) { return read_of_type<T>(place, range); });
}

std::optional<bool> UserParameters::boolean(std::string const& name) {
    return read<bool>(name, {});
}

std::optional<double> UserParameters::number(std::string const& name, double largest) {
    return converted<double>(name, [&](Place const& place) { return read_number(place, largest); });
}

std::optional<std::int64_t> UserParameters::integer(std::string const& name, std::int64_t min, std::int64_t max) {
    std::size_t const read_before = read_.size();
    return converted<std::int64_t>(name, [&](Place const& place) {
        if (std::optional<bool> const truth = truth_of(place.node); truth && conversions_ != Conversions::exact) {
            return std::int64_t{*truth};
        }
        auto const value =
            read_of_type<std::int64_t>(place, between(static_cast<double>(min), static_cast<double>(max)));
        if (read_.size() > read_before) {
            if (conversions_ == Conversions::exact) {
                require_integers(place);
            }
            warn_of_slips(place, {}, /*is_integer=*/true);
        }
        return value;
    });
}

std::optional<std::string> UserParameters::text(std::string const& name, std::size_t most) {
    std::size_t const read_before = read_.size();
    auto text = read<std::string>(name, {});
    if (text && text->size() > most) {
        if (read_.size() > read_before) {
            warn_of_rest({*find_path(parameters_, name), path_of(name)}, "character", text->size(), most);
        }
        text->resize(most);
    }
    return text;
}

std::optional<std::vector<double>> UserParameters::numbers(std::string const& name, std::size_t size, double largest) {
    std::size_t const read_before = read_.size();
    auto numbers = converted<std::vector<double>>(name, [&](Place const& place) {
        Node const& node = place.node;
        std::vector<double> read;
        if (node.kind != Node::Kind::sequence) {
            fail_type(place, fmt::format("a list of at least {} numbers", size));
        }
        if (node.items.empty()) {
            return read;
        }
        if (node.items.size() < size) {
            fail_at(place, fmt::format("expected a list of at least {} numbers, found {}", size, node.items.size()));
        }
        if (node.items.size() > size && read_.size() > read_before) {
            warn_of_rest(place, "number", node.items.size(), size);
        }
        for (std::size_t i = 0; i < size; ++i) {
            read.push_back(read_number({node.items[i], fmt::format("{}.{}", place.path, i)}, largest));
        }
        return read;
    });
    return numbers && numbers->size() < size ? std::nullopt : numbers;  // an empty list
}

void UserParameters::refuse(std::string const& name, std::string const& expected) {
    has_refused_ = true;
    Node const* const node = find_path(parameters_, name);
    if (node == nullptr || node->kind == Node::Kind::null) {
        throw ConfigError(fmt::format("{}: expected {}, found the program's own default", path_of(name), expected));
    }
    fail_expected({*node, path_of(name)}, expected);
}

void UserParameters::check_range(std::string const& name, double value, double min, double max) {
    Range const range = between(min, max);
    if (!range.contains(value)) {
        refuse(name, "a number" + range.text());
    }
}

UnreadParameters UserParameters::unread() const {
    std::vector<Unread> unread;
    collect_unread(parameters_, "", unread);
    std::vector<std::string> nearest;
    for (auto const& [path, node] : unread) {
        nearest.push_back(did_you_mean(shown(path), missed_));
    }
    std::vector<std::string> all;
    std::vector<std::string> suspects;
    for (auto const& [path, node] : unread) {
        std::string hint = nearest[all.size()];
        if (std::ranges::count(nearest, hint) > 1) {
            hint.clear();  // a name that is near to several keys is no slip of theirs
        }
        if (auto const word = misspelt_option(std::string_view(path).substr(path.rfind('.') + 1)); !word.empty()) {
            hint = fmt::format("; did you mean '{}'?", word);
        }
        bool const is_set = node->source == kSetSource;
        if (is_set && hint.empty()) {
            hint = hint_of_set(path);
        }
        all.push_back(fmt::format("{} ({}{})", shown(path), node->where(), hint));
        if (is_set || !hint.empty()) {
            suspects.push_back(all.back());
        }
    }
    if (all.size() == 1) {
        suspects = all;
    }
    std::size_t const others = all.size() - suspects.size();
    std::string brief = fmt::format("{}", fmt::join(suspects, ", "));
    if (others > 0) {
        brief += fmt::format("{}{}{} (-v lists them)", suspects.empty() ? "" : " and ", others,
                             suspects.empty() ? "" : " more");
    }
    return {.all = fmt::format("{}", fmt::join(all, ", ")), .brief = std::move(brief)};
}

std::string UserParameters::hint_of_set(std::string const& path) const {
    std::vector<std::string> asked = found_;
    asked.insert(asked.end(), missed_.begin(), missed_.end());
    if (std::string hint = did_you_mean(shown(path), asked); !hint.empty()) {
        return hint;
    }
    // "traits" is near to no name, but a word of nb_traits.
    std::erase_if(asked, [&](std::string const& name) { return !has_words(name, path); });
    return asked.size() == 1 ? fmt::format("; did you mean '{}'?", asked.front()) : "";
}

bool UserParameters::any_part_was_read(Node const& node) const {
    auto const is_read = [this](Node const& part) { return any_part_was_read(part); };
    return read_.contains(&node) || std::ranges::any_of(node.items, is_read) ||
           std::ranges::any_of(node.entries, [&](auto const& entry) { return is_read(entry.value); });
}

void UserParameters::collect_unread(Node const& node, std::string const& path, std::vector<Unread>& unread) const {
    bool const is_list = !node.items.empty();  // read as a whole
    if (read_.contains(&node) || (is_list && any_part_was_read(node))) {
        return;
    }
    for (auto const& [key, value] : node.entries) {
        collect_unread(value, path.empty() ? key : fmt::format("{}.{}", path, key), unread);
    }
    if (node.entries.empty() && &node != &parameters_) {
        unread.push_back({path, &node});
    }
}

}  // namespace pogosim
