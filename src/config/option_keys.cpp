#include "config/option_keys.hpp"

#include <string_view>

#include "base/nearest_name.hpp"

namespace pogosim {

bool offers_options(Node const& map) {
    return std::ranges::any_of(kValueOptions, [&map](std::string_view key) { return map.find(key) != nullptr; });
}

bool is_slip_of(std::string_view word, std::string_view key) {
    constexpr std::size_t kMostLetters = 2;
    bool const is_as_long = key.size() <= word.size() + kMostLetters && word.size() <= key.size() + kMostLetters;
    return is_as_long && key != word && edit_distance(key, word) <= kMostLetters;
}

std::string_view misspelt_option(std::string_view key) {
    if (is_option_key(key)) {
        return {};
    }
    auto const is_meant = [key](std::string_view word) { return is_slip_of(word, key); };
    auto const found = std::ranges::find_if(kValueOptions, is_meant);
    return found != kValueOptions.end() ? *found : is_meant(kHierarchicalOptions) ? kHierarchicalOptions : "";
}

namespace {

void add_names_of_alternatives(Node const& node, std::vector<std::string>& names) {
    if (Node const* alternatives = node.find(kHierarchicalOptions)) {
        Node const* name = alternatives->find(kAlternativesName);
        if (name != nullptr && name->kind == Node::Kind::scalar) {
            names.push_back(name->scalar);
        }
    }
    for (auto const& [key, value] : node.entries) {
        add_names_of_alternatives(value, names);
    }
    for (Node const& item : node.items) {
        add_names_of_alternatives(item, names);
    }
}

/// All strings of a map, list or value, including keys.
void add_texts(Node const& node, std::vector<std::string>& names) {
    if (node.kind == Node::Kind::scalar) {
        names.push_back(node.scalar);
    }
    for (auto const& [key, value] : node.entries) {
        names.push_back(key);
        add_texts(value, names);
    }
    for (Node const& item : node.items) {
        add_texts(item, names);
    }
}

/// The fields of a Python format: "result_{arena}_{size:02d}.feather" has arena and size.
void add_fields(std::string_view format, std::vector<std::string>& names) {
    for (std::size_t open = format.find('{'); open != std::string_view::npos; open = format.find('{', open + 1)) {
        std::size_t const end = format.find_first_of("}:!", open);
        if (end != std::string_view::npos) {
            names.emplace_back(format.substr(open + 1, end - open - 1));
        }
    }
}

void add_names_of_results(Node const& settings, std::vector<std::string>& names) {
    for (char const* key : {kBatchChoices, "result_new_columns"}) {
        if (Node const* node = settings.find(key)) {
            add_texts(*node, names);
        }
    }
    if (Node const* format = settings.find("result_filename_format")) {
        add_fields(format->scalar, names);
    }
}

}  // namespace

std::vector<std::string> batch_names(Node const& root) {
    std::vector<std::string> names;
    add_names_of_alternatives(root, names);
    for (Node const* const settings : {&root, root.find(kBatchSettings)}) {
        if (settings != nullptr) {
            add_names_of_results(*settings, names);
        }
    }
    return names;
}

}  // namespace pogosim
