// The keys with which a configuration offers alternative values, for batches and optimisations, and the search for
// misspelt ones, which would silently leave out a part of a study. Python has the same lists
// (pogosim/batch/configurations/option_words.py).
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/problems.hpp"
#include "config/tree.hpp"

namespace pogosim {

inline constexpr std::string_view kHierarchicalOptions = "batch_hierarchical_options";
inline constexpr std::string_view kDefaultAlternative = "default";
inline constexpr std::string_view kAlternativesName = "name";
inline constexpr std::string_view kDefaultOption = "default_option";
inline constexpr std::string_view kBatchOptions = "batch_options";
inline constexpr std::string_view kBatchRange = "batch_options_range";
inline constexpr std::string_view kOptimizationDomain = "optimization_domain";

/// Written by batch tools: which alternatives they chose.
inline constexpr char const* kBatchChoices = "_batch_choice_names";

/// Keys of a map that replaces a value.
inline constexpr std::array kValueOptions{kDefaultOption, kBatchOptions, kBatchRange, kOptimizationDomain};

/// Keys of `batch_options_range` and of `optimization_domain`.
inline constexpr std::array<std::string_view, 5> kRangeKeys{"start", "stop", "step", "inclusive", "type"};
inline constexpr std::array<std::string_view, 6> kDomainKeys{"type", "min", "max", "init", "log", "choices"};

/// Top-level maps that only batch tools read: their settings. The simulator does not look at them.
inline constexpr std::string_view kBatchSettings = "pogobatch";
inline constexpr std::array<std::string_view, 2> kMapsOfTools{kBatchSettings, "_rundr"};

/// Top-level entries that do not describe the world: nothing in them is an option.
inline constexpr std::array<std::string_view, 4> kWithoutOptions{"result_filename_format", "result_new_columns",
                                                                 "optimization", kBatchChoices};

inline bool is_option_key(std::string_view key) {
    return key == kHierarchicalOptions || std::ranges::find(kValueOptions, key) != kValueOptions.end();
}

/// Whether a map stands for a value to choose.
bool offers_options(Node const& map);

/// Whether the key differs from the word in one or two letters.
bool is_slip_of(std::string_view word, std::string_view key);

/// The word of options that the key misspells; empty when it is one of them, or resembles none.
std::string_view misspelt_option(std::string_view key);

/// Top-level keys that identify the alternative of a batch: each `name` of `batch_hierarchical_options` anywhere in the
/// tree, and the keys mentioned in `_batch_choice_names`, `result_new_columns` and `result_filename_format`.
std::vector<std::string> batch_names(Node const& root);

/// Adds a mistake, which names the nearest word, wherever
/// - a map of options (with `default_option`, `batch_options`, ...), or one of its ranges and domains, has another key;
/// - a key is one of these words misspelt, so that its map does not count as options. Names that users choose (of
///   parameters, categories and alternatives) may resemble these words, unless the whole map looks like options.
void check_options(Node const& root, Problems& problems);

/// Throws ConfigError for the first key of a map of options at `path` that is none of its words.
void refuse_other_keys(Node const& options, std::string const& path);

}  // namespace pogosim
