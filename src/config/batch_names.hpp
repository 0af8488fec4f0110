// Keys that batch tools add at the top level of a configuration for their own use.
#pragma once

#include <string>
#include <vector>

#include "config/tree.hpp"

namespace pogosim {

/// Top-level keys that identify the alternative of a batch: each `name` of `batch_hierarchical_options` anywhere in the
/// tree, and the keys mentioned in `_batch_choice_names`, `result_new_columns` and `result_filename_format`.
std::vector<std::string> batch_names(Node const& root);

}  // namespace pogosim
