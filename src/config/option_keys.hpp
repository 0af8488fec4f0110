// The keys with which a configuration offers alternative values, for batches and optimisations.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace pogosim {

inline constexpr std::string_view kHierarchicalOptions = "batch_hierarchical_options";
inline constexpr std::string_view kDefaultAlternative = "default";
inline constexpr std::string_view kAlternativesName = "name";
inline constexpr std::string_view kDefaultOption = "default_option";
inline constexpr std::string_view kOptimizationDomain = "optimization_domain";

/// Written by batch tools: which alternatives they chose.
inline constexpr char const* kBatchChoices = "_batch_choice_names";

/// Keys of a map that replaces a value.
inline constexpr std::array kValueOptions{kDefaultOption, std::string_view("batch_options"),
                                          std::string_view("batch_options_range"), kOptimizationDomain};

inline bool is_option_key(std::string_view key) {
    return key == kHierarchicalOptions || std::ranges::find(kValueOptions, key) != kValueOptions.end();
}

}  // namespace pogosim
