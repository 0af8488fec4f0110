// Slips in the keys of options, which would leave out a part of a study without a word.
#pragma once

#include <string>

#include "config/tree.hpp"

namespace pogosim {

/// Throws ConfigError, which names the nearest word, if
/// - a map of options (with `default_option`, `batch_options`, ...), or one of its ranges and domains, has another key;
/// - a key is a slip of these words and so makes a map that is none. Names that users choose may be like them, those of
///   parameters, of categories and of alternatives, unless all of a map looks like options.
void check_options(Node const& root);

/// Throws ConfigError for the first key of a map of options at `path` that is none of its words.
void refuse_other_keys(Node const& options, std::string const& path);

}  // namespace pogosim
