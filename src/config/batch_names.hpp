// Names that batch tools write at the top level of a configuration for their own use.
#pragma once

#include <string>
#include <vector>

#include "config/tree.hpp"

namespace pogosim {

/// Top-level keys that tell which alternative of a batch a file is: `name` of `batch_hierarchical_options` anywhere in
/// the tree, and what `_batch_choice_names`, `result_new_columns` and `result_filename_format` name.
std::vector<std::string> batch_names(Node const& root);

}  // namespace pogosim
