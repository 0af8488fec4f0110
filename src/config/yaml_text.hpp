// Reads YAML that is already in memory.
#pragma once

#include <string>

#include "config/tree.hpp"

namespace pogosim {

/// The first document of `text`; a null node when there is none. `source` is the file name for messages. Errors as in
/// read_yaml_file.
Node parse_yaml(std::string const& text, std::string const& source);

}  // namespace pogosim
