#include "config/option_keys.hpp"

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

}  // namespace pogosim
