// Finds misspelt keys of options, which would silently leave out a part of a study.
#pragma once

#include <string>

#include "base/problems.hpp"
#include "config/tree.hpp"

namespace pogosim {

/// Adds a mistake, which names the nearest word, wherever
/// - a map of options (with `default_option`, `batch_options`, ...), or one of its ranges and domains, has another key;
/// - a key is one of these words misspelt, so that its map does not count as options. Names that users choose (of
///   parameters, categories and alternatives) may resemble these words, unless the whole map looks like options.
void check_options(Node const& root, Problems& problems);

/// Throws ConfigError for the first key of a map of options at `path` that is none of its words.
void refuse_other_keys(Node const& options, std::string const& path);

}  // namespace pogosim
